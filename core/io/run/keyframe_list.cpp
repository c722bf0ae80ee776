#include "core/io/run/keyframe_list.h"

#include <fmt/core.h>

#include "core/config/config.h"
#include "core/config/rigid3_node.h"
#include "core/io/files/atomic_file.h"

namespace saccade {

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

void describe_keyframes(config::Fields& fields, std::vector<KeyframeEntry>& keyframes) {
  int format_version = 1;
  fields.value("format_version", format_version, "layout of this file").required().range(1, 1);
  fields.list("keyframes", keyframes, "in order of time").required();
  for (std::size_t i = 1; i < keyframes.size(); ++i)
    fields.expect(keyframes[i - 1].t_s < keyframes[i].t_s, "keyframes",
                  fmt::format("must be in order of time: {} s stands before {} s",
                              keyframes[i - 1].t_s, keyframes[i].t_s));
  const auto count = static_cast<std::int64_t>(keyframes.size());
  for (const KeyframeEntry& keyframe : keyframes)
    for (const std::int64_t i : keyframe.active)
      fields.expect(i >= 0 && i < count, "keyframes",
                    fmt::format("active keyframe {} is not among the {} in the list", i, count));
}

}  // namespace

std::vector<KeyframeEntry> read_keyframe_list(const std::filesystem::path& file) {
  std::vector<KeyframeEntry> keyframes;
  config::Session::read(config::load(file),
                        [&](config::Fields& fields) { describe_keyframes(fields, keyframes); }, {});
  return keyframes;
}

void write_keyframe_list(const std::filesystem::path& file,
                         std::span<const KeyframeEntry> keyframes) {
  std::vector<KeyframeEntry> list(keyframes.begin(), keyframes.end());
  write_atomically(file, config::to_yaml(config::Session::write(
                             [&](config::Fields& fields) { describe_keyframes(fields, list); })));
}

}  // namespace saccade
