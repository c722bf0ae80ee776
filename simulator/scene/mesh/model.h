#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulator/scene/texture/texture_library.h"

namespace saccade {

/// A texture as a material asks for it.
struct ModelTexture {
  std::string name;  ///< relative to the model's file
  WrapModes wrap;
  std::uint32_t uv_channel = 0;
  std::int32_t embedded =
      -1;  ///< index into the textures that the file holds; -1: a file beside it
};

struct ModelMaterial {
  std::string name;
  std::array<float, 3> colour{0.5F, 0.5F, 0.5F};
  float opacity = 1;
  bool is_linear = false;      ///< colours, else sRGB
  bool ignores_alpha = false;  ///< is opaque whatever its texture says
  std::optional<ModelTexture> colour_texture;
  std::optional<ModelTexture> opacity_texture;
  std::optional<ModelTexture> normal_texture;  ///< of normals in tangent space
  std::vector<std::string> ignored;            ///< what else it states, in words
};

/// Triangles of one material. The attributes have one entry per vertex, or none.
struct ModelPart {
  std::uint32_t material = 0;
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<float, 3>> normals;
  std::vector<std::vector<std::array<float, 2>>> uvs;  ///< by channel; an empty one is not there
  std::vector<std::array<float, 4>> colours;
  std::vector<std::array<float, 4>> tangents;  ///< the last: the handedness of the bitangent
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A part in its place.
struct ModelInstance {
  std::uint32_t part = 0;
  std::uint32_t node = 0;                   ///< index into the model's names of nodes
  std::array<double, 16> file_from_part{};  ///< affine, by column
};

/// A picture inside the model's file: encoded, or BGRA codes where it states its size.
struct ModelPicture {
  std::string hint;  ///< ending of its format
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

/// A camera that the file holds, in the file's coordinates.
struct ModelCamera {
  std::string name;
  std::array<double, 3> position{};
  std::array<double, 3> forward{};  ///< of any length
  double horizontal_fov_rad = 0;    ///< from edge to edge
};

/// What an importer finds in a file, before any texture is read.
struct Model {
  std::vector<ModelMaterial> materials;
  std::vector<ModelPart> parts;
  std::vector<ModelInstance> instances;
  std::vector<std::string> nodes;  ///< names of those that have instances
  std::vector<ModelPicture> pictures;
  std::vector<ModelCamera> cameras;
  std::uint32_t lights = 0, animations = 0;
  std::vector<std::string> opened;  ///< files that were read
};

/// As one piece of bytes, for another process. Reading throws std::runtime_error where they are not
/// what writing makes.
[[nodiscard]] std::string to_bytes(const Model& model);
[[nodiscard]] Model model_from_bytes(const std::string& bytes);

}  // namespace saccade
