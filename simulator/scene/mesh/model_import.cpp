#include "simulator/scene/mesh/model_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "simulator/scene/mesh/assimp_model.h"
#include "simulator/scene/mesh/quake3/quake3_map.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// The indices of a file that nobody checked.
bool is_consistent(const Model& model) {
  const auto is_node = [&model](std::int64_t node) {
    return node < static_cast<std::int64_t>(model.tree.size());
  };
  const auto is_part_fine = [&model, &is_node](const ModelPart& part) {
    return part.material < model.materials.size() &&
           std::ranges::all_of(part.triangles,
                               [&part](const auto& corners) {
                                 return std::ranges::all_of(corners, [&part](std::uint32_t corner) {
                                   return corner < part.vertices.size();
                                 });
                               }) &&
           std::ranges::all_of(part.bones, [&part, &is_node](const ModelBone& bone) {
             return is_node(bone.node) && bone.weights.size() == bone.vertices.size() &&
                    std::ranges::all_of(bone.vertices, [&part](std::uint32_t vertex) {
                      return vertex < part.vertices.size();
                    });
           });
  };
  return std::ranges::all_of(model.parts, is_part_fine) &&
         std::ranges::all_of(model.instances,
                             [&](const ModelInstance& instance) {
                               return instance.part < model.parts.size() &&
                                      instance.node < model.nodes.size() &&
                                      is_node(instance.tree_node);
                             }) &&
         std::ranges::all_of(model.animations, [&](const ModelAnimation& animation) {
           return std::ranges::all_of(animation.channels, [&](const ModelChannel& channel) {
             return is_node(channel.node);
           });
         });
}

Model read_map(const FileSource& own, const fs::path& file) {
  const std::optional<Bytes> bytes = own.read(file);
  if (!bytes) throw std::runtime_error("cannot be opened for reading");
  Model model = read_quake3_map(*bytes);
  model.opened = {file.generic_string()};
  return model;
}

/// What is wrong with an archive of maps in place of one of its maps.
std::string problem_of_archive(const fs::path& file, const std::string& source_name) {
  std::string first;
  std::size_t count = 0;
  for (const fs::path& member : FileSource(file, FileSource::Reporting::kNone).list("maps"))
    if (is_quake3_map(member) && count++ == 0) first = member.generic_string();
  if (count == 0) return "is an archive without maps";
  return fmt::format("is an archive of {} maps: name one of them, as in '{}!/{}'", count,
                     source_name, first);
}

}  // namespace

std::string import_in_child(const FileSource& own, const fs::path& file,
                            const ReplacedFiles& replaced) {
  return to_bytes(is_quake3_map(file) ? read_map(own, file)
                                      : read_through_assimp(own, file, replaced));
}

void check_model_format(const fs::path& file, const std::string& source_name) {
  const std::string extension = file.extension().string();
  if (is_quake3_map(file)) return;
  if (is_quake3_archive(file) && fs::is_regular_file(file))
    throw InputError(source_name, problem_of_archive(file, source_name));
  if (!is_assimp_format(extension))
    throw InputError(source_name,
                     fmt::format("meshes of format '{}' cannot be read; OBJ, glTF, PLY, "
                                 "COLLADA, FBX, STL, BSP and others can",
                                 extension));
}

Model model_of(const ForkedResult& result, const fs::path& file, const std::string& source_name) {
  if (!result.problem.empty())
    throw InputError(source_name,
                     result.died ? fmt::format("cannot be read as a mesh: the importer of '{}' "
                                               "files {}",
                                               file.extension().string(), result.problem)
                                 : result.problem);
  try {
    Model model = model_from_bytes(result.bytes);
    if (!is_consistent(model)) throw std::runtime_error("its parts do not fit together");
    return model;
  } catch (const std::runtime_error& error) {
    throw InputError(source_name, fmt::format("cannot be read as a mesh: {}", error.what()));
  }
}

Model import_model(const FileSource& source, const fs::path& file, const std::string& source_name,
                   const ReplacedFiles& replaced, const ForkLimits& limits) {
  check_model_format(file, source_name);
  const auto work = [&] {
    // An archive that two processes share would be read by both at one position.
    const FileSource own(source.archive(), FileSource::Reporting::kNone);
    return import_in_child(own, file, replaced);
  };
  return model_of(call_in_child(work, limits), file, source_name);
}

}  // namespace saccade
