#pragma once

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <map>
#include <string>
#include <vector>

#include "simulator/scene/mesh/file_source.h"

namespace saccade {

/// Files that an importer shall see with other bytes than they have.
using ReplacedFiles = std::map<std::string, Bytes>;

/// Lets assimp read from a FileSource and remembers what was not there. Both must outlive it.
class AssimpFiles : public Assimp::IOSystem {
 public:
  AssimpFiles(const FileSource& source, const ReplacedFiles& replaced)
      : source_(source), replaced_(replaced) {}

  bool Exists(const char* file) const override { return source_.contains(file); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }

  [[nodiscard]] const std::vector<std::string>& opened() const { return opened_; }
  [[nodiscard]] const std::vector<std::string>& missing() const { return missing_; }

 private:
  const FileSource& source_;
  const ReplacedFiles& replaced_;
  std::vector<std::string> opened_;
  std::vector<std::string> missing_;
};

}  // namespace saccade
