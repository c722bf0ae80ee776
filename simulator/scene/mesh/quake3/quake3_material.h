#pragma once

#include <map>
#include <string>

#include "simulator/scene/mesh/material_import.h"
#include "simulator/scene/mesh/quake3/quake3_files.h"
#include "simulator/scene/mesh/quake3/quake3_shader.h"

namespace saccade {

/// The materials of a Quake III map, whose pictures and scripts lie in the archives of the game.
class Quake3Materials {
 public:
  /// `context` outlives it.
  explicit Quake3Materials(const MaterialContext& context);

  /// The material of a shader. A shader that no script defines is the picture of its name. Throws
  /// InputError naming the picture that is missing or cannot be decoded, unless it may be grey.
  [[nodiscard]] ImportedMaterial read(const ModelMaterial& material);

 private:
  [[nodiscard]] Quake3Shader shader_of(const std::string& name) const;
  [[nodiscard]] TexturePair load(const std::string& picture, Wrap wrap);

  const MaterialContext& context_;
  Quake3Files files_;
  std::map<std::string, Quake3Shader> shaders_;
};

}  // namespace saccade
