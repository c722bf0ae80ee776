#include "core/io/run/view_list.h"

#include <fmt/core.h>

#include "core/config/config.h"
#include "core/config/rigid3_node.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"

namespace saccade {
namespace {

std::filesystem::path relative_to(const std::filesystem::path& file,
                                  const std::filesystem::path& folder) {
  return file.empty() ? file : file.lexically_proximate(folder);
}

std::filesystem::path below(const std::filesystem::path& folder,
                            const std::filesystem::path& file) {
  return file.empty() ? file : folder / file;
}

/// A path as it stands in the file, which no folder is put before.
void describe_path(config::Fields& fields, const char* key, std::filesystem::path& path,
                   const char* help) {
  std::string text = path.generic_string();
  fields.value(key, text, help);
  path = text;
}

}  // namespace

void describe(config::Fields& fields, RunView& view) {
  fields.value("t_s", view.t_s, "time of the view").required();
  fields.value("T_world_camera", view.world_from_camera, "its pose").required();
  fields.value("start_s", view.start_s, "of the events that it was made from");
  fields.value("end_s", view.end_s, "of these events");
  describe_path(fields, "depth", view.depth, "EXR, Z [m] and its variance; empty: none");
  describe_path(fields, "keypoints", view.keypoints, "PNG; empty: none");
  describe_path(fields, "gradient", view.gradient, "EXR; empty: none");
  describe_path(fields, "image", view.image, "EXR; empty: none");
}

namespace {

void describe_views(config::Fields& fields, std::vector<RunView>& views) {
  int format_version = 1;
  fields.value("format_version", format_version, "layout of this file").required().range(1, 1);
  fields.list("views", views, "in order of time").required();
  for (std::size_t i = 1; i < views.size(); ++i)
    fields.expect(views[i - 1].t_s < views[i].t_s, "views",
                  fmt::format("must be in order of time: {} s stands before {} s", views[i - 1].t_s,
                              views[i].t_s));
}

}  // namespace

std::vector<RunView> read_view_list(const std::filesystem::path& file) {
  std::vector<RunView> views;
  config::Session::read(config::load(file),
                        [&](config::Fields& fields) { describe_views(fields, views); }, {});
  const std::filesystem::path folder = file.parent_path();
  for (RunView& view : views)
    for (auto* path : {&view.depth, &view.keypoints, &view.gradient, &view.image})
      *path = below(folder, *path);
  return views;
}

void write_view_list(const std::filesystem::path& file, std::span<const RunView> views) {
  std::vector<RunView> list(views.begin(), views.end());
  const std::filesystem::path folder = file.parent_path();
  for (RunView& view : list)
    for (auto* path : {&view.depth, &view.keypoints, &view.gradient, &view.image})
      *path = relative_to(*path, folder);
  write_atomically(file, config::to_yaml(config::Session::write(
                             [&](config::Fields& fields) { describe_views(fields, list); })));
}

}  // namespace saccade
