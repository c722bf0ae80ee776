#pragma once

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <string>
#include <vector>

#include "simulator/scene/mesh/file_source.h"

namespace saccade {

/// Lets assimp read from a FileSource, which must outlive it, and remembers what was not there.
class AssimpFiles : public Assimp::IOSystem {
 public:
  explicit AssimpFiles(const FileSource& source) : source_(source) {}

  bool Exists(const char* file) const override { return source_.contains(file); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }

  [[nodiscard]] const std::vector<std::string>& opened() const { return opened_; }
  [[nodiscard]] const std::vector<std::string>& missing() const { return missing_; }

 private:
  const FileSource& source_;
  std::vector<std::string> opened_;
  std::vector<std::string> missing_;
};

}  // namespace saccade
