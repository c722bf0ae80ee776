#include "simulator/scene/mesh/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "core/error.h"
#include "core/io/files/json_depth.h"
#include "simulator/scene/mesh/base64.h"
#include "simulator/scene/mesh/gltf_instances.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint32_t kGltfMagic = 0x46546C67;
constexpr std::uint32_t kGltfJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kGltfBinaryChunk = 0x004E4942;
constexpr std::size_t kGltfHeader = 12;
constexpr std::size_t kGltfChunkHeader = 8;

/// Extensions that may be required: what they say is read, or concerns no geometry.
constexpr std::array kGltfFineWhenRequired{
    "KHR_texture_transform", "EXT_texture_webp",    "KHR_texture_basisu",     "MSFT_texture_dds",
    "KHR_mesh_quantization", "KHR_lights_punctual", "EXT_mesh_gpu_instancing"};

std::uint32_t little_endian(const Bytes& bytes, std::size_t at) {
  return bytes[at] | static_cast<std::uint32_t>(bytes[at + 1]) << 8U |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16U |
         static_cast<std::uint32_t>(bytes[at + 3]) << 24U;
}

void append_little_endian(Bytes& bytes, std::size_t value) {
  for (unsigned shift = 0; shift < 32; shift += 8)
    bytes.push_back(static_cast<unsigned char>(value >> shift & 0xFFU));
}

void append_chunk(Bytes& bytes, std::uint32_t type, const Bytes& content, unsigned char padding) {
  const std::size_t padded = (content.size() + 3) / 4 * 4;
  append_little_endian(bytes, padded);
  append_little_endian(bytes, type);
  bytes.insert(bytes.end(), content.begin(), content.end());
  bytes.insert(bytes.end(), padded - content.size(), padding);
}

std::string percent_decoded(const std::string& uri) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
  };
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool is_code =
        uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
    text += is_code ? static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i];
    if (is_code) i += 2;
  }
  return text;
}

/// Numbers of one element, by the name of its type.
std::size_t gltf_width(const std::string& type) {
  if (type == "SCALAR") return 1;
  return type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4;
}

template <class T>
float gltf_number(const unsigned char* bytes, bool is_normalized) {
  T value{};
  std::memcpy(&value, bytes, sizeof(T));
  if constexpr (std::is_floating_point_v<T>) return value;
  const auto number = static_cast<float>(value);
  if (!is_normalized) return number;
  return std::max(number / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
}

struct GltfComponent {
  std::size_t size;
  float (*read)(const unsigned char*, bool);
};

/// By its OpenGL code; size 0 where there is none.
GltfComponent gltf_component(std::uint64_t code) {
  switch (code) {
    case 5120:
      return {1, gltf_number<std::int8_t>};
    case 5121:
      return {1, gltf_number<std::uint8_t>};
    case 5122:
      return {2, gltf_number<std::int16_t>};
    case 5123:
      return {2, gltf_number<std::uint16_t>};
    case 5125:
      return {4, gltf_number<std::uint32_t>};
    case 5126:
      return {4, gltf_number<float>};
    default:
      return {0, nullptr};
  }
}

constexpr std::uint64_t kGltfFloat = 5126;

bool is_attribute_shown(const std::string& name, bool is_moving) {
  return name == "POSITION" || name == "NORMAL" || name == "TANGENT" ||
         name.starts_with("TEXCOORD_") || name == "COLOR_0" ||
         (is_moving && (name == "JOINTS_0" || name == "WEIGHTS_0"));
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

}  // namespace

std::optional<GltfFile> GltfFile::open(const FileSource& source, const fs::path& file,
                                       const std::string& source_name) {
  const std::string ending = lower_case(file.extension().string());
  if (ending != ".gltf" && ending != ".glb") return std::nullopt;
  const std::optional<Bytes> bytes = source.read(file);
  if (!bytes) return std::nullopt;
  GltfFile gltf(source, file, source_name);
  try {
    gltf.parse(*bytes);
    const json& asset = gltf.document_.contains("asset") ? gltf.document_["asset"] : json();
    const std::string version =
        asset.is_object() && asset.contains("version") && asset["version"].is_string()
            ? asset["version"].get<std::string>()
            : "";
    if (!version.starts_with("2")) return std::nullopt;
    gltf.check_extensions();
    expand_gltf_instances(
        {[&](std::size_t index, std::size_t width) {
           const json& stated = gltf.item("accessors", index);
           if (stated.is_object() && gltf_width(stated.at("type").get<std::string>()) != width)
             gltf.fail(fmt::format("accessor {} is not of {} numbers", index, width));
           return gltf.accessor(index);
         },
         [&](const std::string& problem) { gltf.fail(problem); }},
        gltf.document_);
  } catch (const json::exception& error) {
    gltf.fail(error.what());
  }
  return gltf;
}

void GltfFile::fail(const std::string& problem) const {
  throw InputError(source_name_, "cannot be read as glTF: " + problem);
}

json GltfFile::parse_json(std::span<const unsigned char> text) const {
  const std::string_view letters(reinterpret_cast<const char*>(text.data()), text.size());
  if (const auto byte = json_too_deep_at(letters))
    fail(fmt::format("its JSON is nested too deeply at byte {}", *byte));
  return json::parse(letters);
}

void GltfFile::parse(const Bytes& bytes) {
  is_binary_ = bytes.size() >= kGltfHeader && little_endian(bytes, 0) == kGltfMagic;
  if (!is_binary_) {
    document_ = parse_json(bytes);
  } else {
    // A binary glTF 1.0 has another second header.
    if (little_endian(bytes, 4) != 2) return;
    std::size_t at = kGltfHeader;
    while (at + kGltfChunkHeader <= bytes.size()) {
      const std::size_t size = little_endian(bytes, at);
      const std::uint32_t type = little_endian(bytes, at + 4);
      at += kGltfChunkHeader;
      if (size > bytes.size() - at) fail("it ends too early");
      const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
      const auto end = begin + static_cast<std::ptrdiff_t>(size);
      if (type == kGltfJsonChunk && document_.is_null()) document_ = parse_json({begin, end});
      if (type == kGltfBinaryChunk && binary_chunk_.empty()) binary_chunk_.assign(begin, end);
      at += size;
    }
  }
  if (!document_.is_object()) fail("it holds no JSON object");
}

void GltfFile::check_extensions() const {
  if (!document_.contains("extensionsRequired")) return;
  for (const json& item : document_["extensionsRequired"]) {
    const auto name = item.get<std::string>();
    if (name.starts_with("KHR_materials_") ||
        std::ranges::find(kGltfFineWhenRequired, name) != kGltfFineWhenRequired.end())
      continue;
    fail(fmt::format("it needs the extension {}, which is not supported: save it without", name));
  }
}

const json& GltfFile::item(const char* key, std::size_t index) const {
  static const json kNone;
  if (!document_.contains(key) || !document_[key].is_array() || index >= document_[key].size())
    return kNone;
  return document_[key][index];
}

std::optional<Bytes> GltfFile::resource(const std::string& uri) const {
  constexpr std::string_view kData = "data:";
  if (uri.starts_with(kData)) {
    const std::size_t comma = uri.find(',');
    std::optional<Bytes> bytes;
    if (comma != std::string::npos && uri.substr(0, comma).ends_with(";base64"))
      bytes = bytes_of_base64(std::string_view(uri).substr(comma + 1));
    if (!bytes) fail("a data URI is not in base64");
    return bytes;
  }
  return source_->read((file_.parent_path() / percent_decoded(uri)).lexically_normal());
}

const Bytes& GltfFile::buffer(std::size_t index) const {
  const auto known = buffers_.find(index);
  if (known != buffers_.end()) return known->second;
  const json& stated = item("buffers", index);
  if (!stated.is_object()) fail(fmt::format("it has no buffer {}", index));
  if (!stated.contains("uri")) {
    if (index != 0 || !is_binary_) fail(fmt::format("buffer {} has no URI", index));
    return binary_chunk_;
  }
  const auto uri = stated["uri"].get<std::string>();
  std::optional<Bytes> bytes = resource(uri);
  if (!bytes) fail(fmt::format("its buffer {} does not exist", uri));
  return buffers_[index] = std::move(*bytes);
}

Bytes GltfFile::buffer_view(std::size_t index) const {
  const json& view = item("bufferViews", index);
  if (!view.is_object()) fail(fmt::format("it has no buffer view {}", index));
  const Bytes& bytes = buffer(view.at("buffer").get<std::size_t>());
  const auto offset = view.value("byteOffset", std::size_t{0});
  const auto length = view.at("byteLength").get<std::size_t>();
  if (offset > bytes.size() || length > bytes.size() - offset)
    fail(fmt::format("buffer view {} is outside its buffer", index));
  const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(offset);
  return {begin, begin + static_cast<std::ptrdiff_t>(length)};
}

std::vector<float> GltfFile::accessor(std::size_t index) const {
  const json& stated = item("accessors", index);
  if (!stated.is_object()) fail(fmt::format("it has no accessor {}", index));
  const std::size_t width = gltf_width(stated.at("type").get<std::string>());
  const GltfComponent component = gltf_component(stated.at("componentType").get<std::uint64_t>());
  if (component.size == 0 || stated.contains("sparse") || !stated.contains("bufferView"))
    fail(fmt::format("accessor {} is of an unknown kind, or sparse and not of floats", index));
  const auto view_index = stated["bufferView"].get<std::size_t>();
  const Bytes bytes = buffer_view(view_index);
  const std::size_t stride =
      item("bufferViews", view_index).value("byteStride", width * component.size);
  const auto count = stated.at("count").get<std::size_t>();
  const auto offset = stated.value("byteOffset", std::size_t{0});
  const std::size_t element = width * component.size;
  if (count == 0) return {};
  if (stride < element || std::max({stride, count, offset}) > bytes.size() ||
      offset + (count - 1) * stride + element > bytes.size())
    fail(fmt::format("accessor {} is outside its buffer view", index));
  const bool is_normalized = stated.value("normalized", false);
  std::vector<float> numbers;
  numbers.reserve(count * width);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < width; ++k)
      numbers.push_back(
          component.read(bytes.data() + offset + i * stride + k * component.size, is_normalized));
  return numbers;
}

/// assimp copies the bytes of an attribute as if they were floats, whatever they are.
void GltfFile::make_attributes_float(json& document) const {
  std::map<std::size_t, std::size_t> converted;
  Bytes floats;
  const std::size_t new_buffer = document.contains("buffers") ? document["buffers"].size() : 0;
  const auto convert = [&](std::size_t index) {
    const auto known = converted.find(index);
    if (known != converted.end()) return known->second;
    const std::vector<float> numbers = accessor(index);
    const auto* bytes = reinterpret_cast<const unsigned char*>(numbers.data());
    const std::size_t size = numbers.size() * sizeof(float);
    document["bufferViews"].push_back(
        {{"buffer", new_buffer}, {"byteOffset", floats.size()}, {"byteLength", size}});
    floats.insert(floats.end(), bytes, bytes + size);
    json stated = item("accessors", index);
    for (const char* key : {"byteOffset", "normalized", "min", "max"}) stated.erase(key);
    stated["componentType"] = kGltfFloat;
    stated["bufferView"] = document["bufferViews"].size() - 1;
    document["accessors"].push_back(std::move(stated));
    return converted[index] = document["accessors"].size() - 1;
  };
  for (json& mesh : document["meshes"])
    for (json& primitive : mesh.at("primitives"))
      for (auto& [name, index] : primitive.at("attributes").items()) {
        if (name == "JOINTS_0") continue;  // indices
        const json& stated = item("accessors", index.get<std::size_t>());
        if (stated.is_object() && stated.value("componentType", kGltfFloat) != kGltfFloat)
          index = convert(index.get<std::size_t>());
      }
  if (!floats.empty())
    document["buffers"].push_back(
        {{"byteLength", floats.size()},
         {"uri", "data:application/octet-stream;base64," + base64_of(floats)}});
}

void GltfFile::add_inverse_binds(json& document) {
  constexpr std::array<float, 16> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  if (!document.contains("skins")) return;
  for (json& skin : document["skins"]) {
    if (skin.contains("inverseBindMatrices")) continue;
    const std::size_t count = skin.at("joints").size();
    Bytes matrices(count * sizeof kIdentity);
    for (std::size_t k = 0; k < count; ++k)
      std::memcpy(matrices.data() + k * sizeof kIdentity, kIdentity.data(), sizeof kIdentity);
    document["buffers"].push_back(
        {{"byteLength", matrices.size()},
         {"uri", "data:application/octet-stream;base64," + base64_of(matrices)}});
    document["bufferViews"].push_back({{"buffer", document["buffers"].size() - 1},
                                       {"byteOffset", 0},
                                       {"byteLength", matrices.size()}});
    document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                     {"componentType", kGltfFloat},
                                     {"count", count},
                                     {"type", "MAT4"}});
    skin["inverseBindMatrices"] = document["accessors"].size() - 1;
  }
}

Bytes GltfFile::encoded(json document) const {
  // assimp takes the first buffer of a binary file for its binary chunk, whether it has one or not.
  Bytes chunk = binary_chunk_;
  if (is_binary_ && chunk.empty() && document.contains("buffers") && !document["buffers"].empty()) {
    chunk = buffer(0);
    document["buffers"][0].erase("uri");
  }

  const std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
  Bytes content(text.begin(), text.end());
  if (!is_binary_) return content;
  Bytes chunks;
  append_chunk(chunks, kGltfJsonChunk, content, ' ');
  if (!chunk.empty()) append_chunk(chunks, kGltfBinaryChunk, chunk, 0);
  Bytes file;
  append_little_endian(file, kGltfMagic);
  append_little_endian(file, 2);
  append_little_endian(file, kGltfHeader + chunks.size());
  file.insert(file.end(), chunks.begin(), chunks.end());
  return file;
}

ReplacedFiles GltfFile::for_assimp(Stillness stillness) const {
  const bool is_moving = stillness == Stillness::kMoving;
  json document = document_;
  try {
    for (const char* key : {"textures", "images", "samplers", "animations", "extensionsUsed",
                            "extensionsRequired", "extensions"})
      document.erase(key);
    if (!is_moving) document.erase("skins");
    if (document.contains("materials")) {
      json materials = json::array();
      for (std::size_t i = 0; i < document["materials"].size(); ++i)
        materials.push_back({{"name", std::to_string(i)}});
      document["materials"] = std::move(materials);
    }
    if (document.contains("nodes"))
      for (std::size_t i = 0; i < document["nodes"].size(); ++i) {
        json& node = document["nodes"][i];
        for (const char* key : {"weights", "extensions"}) node.erase(key);
        if (is_moving)
          node["name"] = std::to_string(i);
        else
          node.erase("skin");
      }
    if (document.contains("meshes")) {
      for (json& mesh : document["meshes"])
        for (json& primitive : mesh.at("primitives")) {
          for (const char* key : {"targets", "extensions"}) primitive.erase(key);
          json& attributes = primitive.at("attributes");
          for (auto it = attributes.begin(); it != attributes.end();)
            it = is_attribute_shown(it.key(), is_moving) ? std::next(it) : attributes.erase(it);
        }
      make_attributes_float(document);
      add_inverse_binds(document);
    }
    return {{file_.generic_string(), encoded(std::move(document))}};
  } catch (const json::exception& error) {
    fail(error.what());
  }
}

GltfFile::NamedBytes GltfFile::image(std::size_t index) const {
  try {
    const json& stated = item("images", index);
    if (!stated.is_object()) fail(fmt::format("it has no image {}", index));
    if (stated.contains("uri") && !stated["uri"].get<std::string>().starts_with("data:")) {
      const auto uri = stated["uri"].get<std::string>();
      std::optional<Bytes> bytes = resource(uri);
      const fs::path name = (file_.parent_path() / percent_decoded(uri)).lexically_normal();
      const std::string text = FileLocation{source_->archive(), name}.text();
      if (!bytes)
        throw InputError(source_name_, fmt::format("its texture {} does not exist", text));
      return {text, std::move(*bytes)};
    }
    std::string type = stated.value("mimeType", "");
    type.erase(0, type.find('/') + 1);
    const std::string name = fmt::format("{}:image {} '{}'{}{}", source_name_, index,
                                         stated.value("name", ""), type.empty() ? "" : ".", type);
    if (stated.contains("uri")) return {name, *resource(stated["uri"].get<std::string>())};
    return {name, buffer_view(stated.at("bufferView").get<std::size_t>())};
  } catch (const json::exception& error) {
    fail(error.what());
  }
}

}  // namespace saccade
