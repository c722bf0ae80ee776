#include "core/io/run/keyframe_list.h"

#include <fmt/core.h>

#include "core/config/config.h"
#include "core/config/rigid3_node.h"
#include "core/io/files/atomic_file.h"

namespace saccade {
namespace {

struct KeyframeList {
  int format_version = 1;
  std::vector<KeyframeEntry> keyframes;
};

}  // namespace

void describe(config::Fields& fields, KeyframeEntry& keyframe) {
  fields.value("t_s", keyframe.t_s, "time of its view").required();
  fields.value("T_world_camera", keyframe.world_from_camera, "pose of its view").required();
  fields.value("made_s", keyframe.made_s, "last event that it was made of").required();
  fields.value("taken_s", keyframe.taken_s, "last event before it came into force").required();
  fields.value("events", keyframe.events, "that it was made of").at_least(0);
  fields.value("points", keyframe.points, "with depth").at_least(0);
  fields.value("edges", keyframe.edges, "that became the map: so many points of map.ply, in order")
      .at_least(0);
  fields.value("typical_depth_m", keyframe.typical_depth_m, "median of its depths");
  fields.value("active", keyframe.active, "keyframes that made up the map from then on, by index");
}

namespace {

void describe(config::Fields& fields, KeyframeList& list) {
  fields.value("format_version", list.format_version, "layout of this file").required().range(1, 1);
  fields.list("keyframes", list.keyframes, "in order of time").required();
  for (std::size_t i = 1; i < list.keyframes.size(); ++i)
    fields.expect(list.keyframes[i - 1].t_s < list.keyframes[i].t_s, "keyframes",
                  fmt::format("must be in order of time: {} s stands before {} s",
                              list.keyframes[i - 1].t_s, list.keyframes[i].t_s));
  const auto count = static_cast<std::int64_t>(list.keyframes.size());
  for (const KeyframeEntry& keyframe : list.keyframes)
    for (const std::int64_t i : keyframe.active)
      fields.expect(i >= 0 && i < count, "keyframes",
                    fmt::format("active keyframe {} is not among the {} in the list", i, count));
}

}  // namespace

std::vector<KeyframeEntry> read_keyframe_list(const std::filesystem::path& file) {
  return config::read<KeyframeList>(config::load(file)).keyframes;
}

void write_keyframe_list(const std::filesystem::path& file,
                         std::span<const KeyframeEntry> keyframes) {
  KeyframeList list;
  list.keyframes.assign(keyframes.begin(), keyframes.end());
  write_atomically(file, config::print(list));
}

}  // namespace saccade
