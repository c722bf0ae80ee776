// Models, textures and the configuration of a simulation.

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/file_bytes.h"
#include "core/io/images/png_file.h"
#include "simulator/scene/mesh/ac3d_file.h"
#include "simulator/scene/mesh/gltf_file.h"
#include "simulator/scene/mesh/model_import.h"
#include "simulator/scene/mesh/quake3/quake3_map.h"
#include "simulator/scene/mesh/quake3/quake3_shader.h"
#include "simulator/scene/texture/picture.h"
#include "simulator/simulation_config.h"
#include "tests/fuzz/fuzz_target.h"

namespace saccade::fuzz {
namespace {

namespace fs = std::filesystem;

/// A triangle with a texture inside the file.
constexpr std::string_view kGltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"n"}],)"
    R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],)"
    R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],)"
    R"("images":[{"bufferView":3,"mimeType":"image/png"}],"skins":[{"joints":[0]}],)"
    R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},)"
    R"({"bufferView":1,"componentType":5121,"normalized":true,"count":3,"type":"VEC2"},)"
    R"({"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"}],)"
    R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},)"
    R"({"buffer":0,"byteOffset":42,"byteLength":6},{"buffer":0,"byteOffset":0,"byteLength":48}],)"
    R"("buffers":[{"byteLength":48,"uri":"data:application/octet-stream;base64,)";

void write_models(const fs::path& folder) {
  // 48 zero bytes.
  write_bytes(folder / "m.gltf", std::string(kGltf) + std::string(64, 'A') + "\"}]}");
  const auto source = FileSource();
  const auto gltf = GltfFile::open(source, folder / "m.gltf", "m.gltf");
  write_bytes(folder / "m.obj",
              "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
  write_bytes(folder / "m.mtl", "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd a.png\nd 0.9\n");
  write_bytes(
      folder / "m.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 "
      "0 1 "
      "2\n");
  write_bytes(
      folder / "m.ac",
      "AC3Db\nMATERIAL \"a\" rgb 1 1 1 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0\nOBJECT "
      "world\nkids 1\nOBJECT poly\nname \"p\"\ntexture \"a.png\" base\nnumvert 3\n0 0 0\n1 0 0\n0 "
      "1 "
      "0\nnumsurf 1\nSURF 0x20\nmat 0\nrefs 3\n0 0 0\n1 1 0\n2 0 1\nkids 0\n");
  write_bytes(folder / "a.png", encode_png(ImageU8(2, 2, 9)));
}

/// What runs in this process; assimp runs in another one, under limits.
void decode_gltf(const fs::path& folder, const std::string& file) {
  const FileSource source;
  const auto gltf = GltfFile::open(source, folder / file, file);
  if (!gltf) throw InputError(file, "is no glTF 2.0");
  static_cast<void>(gltf->for_assimp(GltfFile::Stillness::kMoving));
  static_cast<void>(gltf->for_assimp());
  SceneRemarks remarks;
  for (std::size_t i = 0; i < 2 && gltf->item("images", i).is_object(); ++i) {
    const auto image = gltf->image(i);
    static_cast<void>(decode_opacity(image.bytes, image.name, remarks));
  }
}

void write_gltf(const fs::path& folder) {
  write_models(folder);
  std::string text(kGltf);
  text.replace(text.find("\"images\""),
               std::string_view(R"("images":[{"bufferView":3,"mimeType":"image/png"}],)").size(),
               R"("images":[{"uri":"a.png"}],)");
  write_bytes(folder / "m.gltf", text + std::string(64, 'A') + "\"}]}");
}

void decode_models(const fs::path& folder, const std::string& file) {
  constexpr ForkLimits kLimits{.cpu_s = 5, .wall_s = 9, .memory_mb = 1024};
  const FileSource source;
  ReplacedFiles replaced;
  if (file == "m.ac") replaced = ac3d_for_assimp(source, folder / file);
  const std::string model = file == "m.mtl" ? "m.obj" : file;
  static_cast<void>(import_model(source, folder / model, model, replaced, kLimits));
}

/// A map of one triangle and a player; entities come behind the tables of numbers.
void write_quake3(const fs::path& folder) {
  std::string map("IBSP\x2e\0\0\0", 8);
  const std::string entities =
      "{\"classname\" \"worldspawn\"}{\"classname\" \"info_player_start\" \"origin\" \"1 2 3\"}";
  constexpr std::array<std::uint32_t, 17> kSizes{0, 72, 0, 0, 0, 0, 0, 40, 0, 0, 132, 12, 0, 104};
  std::uint32_t offset = 144;
  const auto put = [&map](std::uint32_t value) {
    map.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (std::size_t lump = 0; lump < kSizes.size(); ++lump) {
    put(lump == 0 ? 144 + 72 + 40 + 132 + 12 + 104 : offset);
    put(lump == 0 ? static_cast<std::uint32_t>(entities.size()) : kSizes[lump]);
    offset += kSizes[lump];
  }
  map += "textures/a" + std::string(62, '\0') + std::string(24, '\0');
  for (const std::uint32_t value : {0U, 1U, 0U, 0U}) put(value);  // faces of the world
  map.append(132, '\0');
  for (const std::uint32_t corner : {0U, 1U, 2U}) put(corner);
  for (const std::uint32_t value : {0U, 0U, 1U, 0U, 3U, 0U, 3U}) put(value);
  write_bytes(folder / "m.bsp", map + std::string(76, '\0') + entities);
  write_bytes(folder / "s.shader",
              "textures/a\n{\nsurfaceparm nomarks\n{\nmap $lightmap\n}\n{\nmap a.tga\nblendFunc "
              "filter\ntcMod scale 2 2\n}\n}\n");
}

void decode_quake3(const fs::path& folder, const std::string& file) {
  const std::vector<std::byte> content = read_file_bytes(folder / file);
  const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
  if (file == "s.shader") {
    static_cast<void>(parse_quake3_script(text));
    return;
  }
  try {
    static_cast<void>(read_quake3_map(Bytes(text.begin(), text.end())));
  } catch (const std::runtime_error& error) {
    throw InputError(file, error.what());
  }
}

void write_textures(const fs::path& folder) {
  write_bytes(folder / "a.png", encode_png(ImageU8(3, 2, 9)));
  write_bytes(folder / "a.hdr",
              "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n" + std::string(16, '\x80'));
}

void decode_textures(const fs::path& folder, const std::string& file) {
  const std::vector<std::byte> content = read_file_bytes(folder / file);
  const auto* first = reinterpret_cast<const unsigned char*>(content.data());
  const Bytes bytes(first, first + content.size());
  SceneRemarks remarks;
  static_cast<void>(decode_picture(bytes, file, remarks));
  static_cast<void>(decode_opacity(bytes, file, remarks));
}

void write_simulation(const fs::path& folder) {
  write_bytes(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_bytes(folder / "s.yaml",
              "scene:\n  meshes:\n    - {file: a.obj, transform: {scale: 2}}\n  background: "
              "0.5\ntrajectory: "
              "{source: circle, radius_m: 1}\nduration_s: 0.5\ncamera: {width: 24, height: 18, fx: "
              "20, fy: 20, cx: "
              "11.5, cy: 8.5}\nevents: {contrast_on: 0.2, preset: davis240c}\nrig: []\nseed: 3\n");
}

void decode_simulation(const fs::path& folder, const std::string& file) {
  const auto read = config::read<SimulationConfig>(config::load(folder / file));
  static_cast<void>(config::print(read));
}

std::vector<std::string> key_names() {
  std::vector<std::string> words;
  for (const config::ReferenceKey& key : config::reference<SimulationConfig>())
    words.push_back(key.name.substr(key.name.rfind('.') + 1) + ": ");
  return words;
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all{
      {"gltf",
       {"m.gltf"},
       decode_gltf,
       write_gltf,
       {"\"sparse\":", "\"byteStride\":", "\"byteOffset\":", "\"extensionsRequired\":[", "glTF\x02",
        "KHR_texture_transform", "\"MAT4\"", "4294967295", "[[[[[[[[", "{\"a\":"}},
      {"models",
       {"m.obj", "m.mtl", "m.ply", "m.ac"},
       decode_models,
       write_models,
       {"element face 4294967295\n", "numvert 4294967295\n", "kids 4294967295\n", "f 1 2 3\n",
        "vt 1e308 nan\n"}},
      {"quake3",
       {"m.bsp", "s.shader"},
       decode_quake3,
       write_quake3,
       {"IBSP", "\"classname\" \"light\"", "\"model\" \"*1\"", "\"angles\" \"1e300 nan 0\"",
        "blendfunc", "alphafunc", "skyparms", "deformvertexes autosprite", "/*", "//"}},
      {"textures",
       {"a.png", "a.hdr"},
       decode_textures,
       write_textures,
       {"IHDR", "IDAT", "-Y 2 +X 2\n"}},
      {"simulation", {"s.yaml"}, decode_simulation, write_simulation, key_names()}};
  return all;
}

}  // namespace saccade::fuzz
