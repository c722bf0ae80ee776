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

/// A node that moves some vertices of a part along.
struct ModelBone {
  std::string name;
  std::int32_t node = -1;                   ///< index into the model's tree; -1: there is none
  std::array<double, 16> bone_from_part{};  ///< where the part was bound; affine, by column
  std::vector<std::uint32_t> vertices;
  std::vector<float> weights;  ///< one for each of these
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
  std::vector<ModelBone> bones;  ///< none: the part moves with its node
};

/// A part in its place.
struct ModelInstance {
  std::uint32_t part = 0;
  std::uint32_t node = 0;                   ///< index into the model's names of nodes
  std::uint32_t tree_node = 0;              ///< index into its tree
  std::array<double, 16> file_from_part{};  ///< affine, by column
};

/// A picture inside the model's file: encoded, or BGRA codes where it states its size.
struct ModelPicture {
  std::string hint;  ///< ending of its format
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

/// A camera that the file holds.
struct ModelCamera {
  std::string name;
  std::int32_t node = -1;            ///< index into the model's tree; -1: the file's coordinates
  std::array<double, 3> position{};  ///< in the node
  std::array<double, 3> forward{0, 0, 1};  ///< likewise, of any length
  std::array<double, 3> up{0, 1, 0};       ///< likewise, across `forward` or nearly so
  double horizontal_fov_rad = 0;           ///< from edge to edge; 0: not stated
  double vertical_fov_rad = 0;             ///< likewise
};

/// A place in the hierarchy of a file. Children come after their parents.
struct ModelNode {
  std::string name;
  std::int32_t parent = -1;  ///< -1: a root
  std::array<double, 16> parent_from_node{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

/// What a value is between two keys.
enum class KeyInterpolation : std::uint8_t { kStep, kLinear, kCubic };

/// Keys of a vector, or of a rotation (x, y, z, w), at increasing times. Before the first and after
/// the last one the value is theirs.
struct ModelTrack {
  KeyInterpolation interpolation = KeyInterpolation::kLinear;
  std::vector<double> times_s;
  std::vector<double> values;  ///< key by key; cubic: slope before it, value, slope after it
};

/// How one node moves in its parent. What has no keys stays as it is in the file.
struct ModelChannel {
  std::uint32_t node = 0;  ///< index into the model's tree
  ModelTrack translation, rotation, scale;
};

/// A motion of some nodes from time 0 on.
struct ModelAnimation {
  std::string name;
  double duration_s = 0;
  std::vector<ModelChannel> channels;
};

/// What an importer finds in a file, before any texture is read.
struct Model {
  std::vector<ModelMaterial> materials;
  std::vector<ModelPart> parts;
  std::vector<ModelInstance> instances;
  std::vector<std::string> nodes;  ///< names of those that have instances
  std::vector<ModelPicture> pictures;
  std::vector<ModelCamera> cameras;
  std::vector<ModelNode> tree;
  std::vector<ModelAnimation> animations;
  std::uint32_t lights = 0;
  std::vector<std::string> opened;  ///< files that were read
};

/// As one piece of bytes, for another process. Reading throws std::runtime_error where they are not
/// what writing makes.
[[nodiscard]] std::string to_bytes(const Model& model);
[[nodiscard]] Model model_from_bytes(const std::string& bytes);

}  // namespace saccade
