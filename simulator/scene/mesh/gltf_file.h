#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/mesh/model_import.h"

namespace saccade {

/// A glTF 2.0 file, text or binary. Its materials, textures and extensions are read from its JSON,
/// because assimp drops some of them; the geometry is left to assimp. All members throw InputError
/// naming the file where it is not as the specification has it (Khronos, glTF 2.0, 2021).
class GltfFile {
 public:
  /// nullopt for a file of glTF 1.0. Throws where an extension is required that changes the
  /// geometry and is not supported.
  [[nodiscard]] static std::optional<GltfFile> open(const FileSource& source,
                                                    const std::filesystem::path& file,
                                                    const std::string& source_name);

  [[nodiscard]] const nlohmann::json& document() const { return document_; }
  [[nodiscard]] const std::string& source_name() const { return source_name_; }
  /// Member `key` of the document, or null.
  [[nodiscard]] const nlohmann::json& item(const char* key, std::size_t index) const;

  /// Whether assimp shall see what moves a mesh.
  enum class Stillness { kStill, kMoving };
  /// The file as assimp shall see it: material k is called "k" and has no textures, and all vertex
  /// attributes are floats. Nothing moves, or node k is called "k" and has its skin.
  [[nodiscard]] ReplacedFiles for_assimp(Stillness stillness = Stillness::kStill) const;

  /// All numbers of an accessor, as floats.
  [[nodiscard]] std::vector<float> accessor(std::size_t index) const;

  struct NamedBytes {
    std::string name;  ///< for errors; with the ending of its format
    Bytes bytes;
  };
  /// Encoded picture of item `index` of `images`.
  [[nodiscard]] NamedBytes image(std::size_t index) const;

 private:
  GltfFile(const FileSource& source, std::filesystem::path file, std::string source_name)
      : source_(&source), file_(std::move(file)), source_name_(std::move(source_name)) {}

  [[noreturn]] void fail(const std::string& problem) const;
  void parse(const Bytes& bytes);
  [[nodiscard]] nlohmann::json parse_json(std::span<const unsigned char> text) const;
  void check_extensions() const;
  /// nullopt: the file that it names does not exist.
  [[nodiscard]] std::optional<Bytes> resource(const std::string& uri) const;
  [[nodiscard]] const Bytes& buffer(std::size_t index) const;
  [[nodiscard]] Bytes buffer_view(std::size_t index) const;
  void make_attributes_float(nlohmann::json& document) const;
  /// States the matrices of skins that state none, for assimp, which needs them.
  static void add_inverse_binds(nlohmann::json& document);
  [[nodiscard]] Bytes encoded(nlohmann::json document) const;

  const FileSource* source_;
  std::filesystem::path file_;
  std::string source_name_;
  nlohmann::json document_;
  bool is_binary_ = false;
  Bytes binary_chunk_;
  mutable std::map<std::size_t, Bytes> buffers_;
};

}  // namespace saccade
