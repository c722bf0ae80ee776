#include "simulator/scene/animation/model_motion.h"

#include <optional>

#include "core/error.h"
#include "simulator/scene/animation/gltf_motion.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/mesh/gltf_file.h"
#include "simulator/scene/mesh/model_import.h"

namespace saccade {

Model read_model_motion(const std::filesystem::path& file) {
  const std::string problem = missing_file_problem(file);
  if (!problem.empty()) throw InputError(file.string(), problem);
  const FileLocation location = FileLocation::parse(file);
  const FileSource source(location.archive);
  const std::string source_name = location.text();
  if (const auto gltf = GltfFile::open(source, location.file, source_name)) {
    Model model;
    take_gltf_motion(*gltf, model);
    return model;
  }
  Model model = import_model(source, location.file, source_name);
  // What the importer read in its own process is noted in the InputLog of this one.
  for (const std::string& opened : model.opened) static_cast<void>(source.read(opened));
  return model;
}

}  // namespace saccade
