#include "core/io/events/labels_h5.h"

#include <array>
#include <vector>

#include "core/check.h"

namespace saccade {
namespace {

constexpr const char* kLabelsGroup = "labels";

std::array<H5Source, 7> columns_of(const EventLabels& labels) {
  return {h5_source("depth", labels.depth),   h5_source("flow_x", labels.flow_x),
          h5_source("flow_y", labels.flow_y), h5_source("object", labels.object),
          h5_source("origin", labels.origin), h5_source("instance", labels.instance),
          h5_source("class", labels.class_id)};
}

void take_objects_for_instances(EventLabels& labels) {
  for (std::size_t i = 0; i < labels.size(); ++i)
    labels.instance[i] = static_cast<std::uint16_t>(labels.object[i] + 1);
}

}  // namespace

void EventLabels::resize(std::size_t count) {
  depth.resize(count);
  flow_x.resize(count);
  flow_y.resize(count);
  object.resize(count);
  instance.resize(count);
  class_id.resize(count);
  origin.resize(count);
}

LabelsH5Writer::LabelsH5Writer(const std::filesystem::path& file)
    : table_(file, kLabelsGroup, columns_of({})) {}

void LabelsH5Writer::append(const EventLabels& labels) { table_.append(columns_of(labels)); }

EventLabels read_labels_h5(const std::filesystem::path& file, std::uint64_t count,
                           std::uint64_t begin, std::uint64_t end) {
  SACCADE_CHECK(begin <= end && end <= count);
  EventLabels labels;
  labels.resize(end - begin);
  std::vector<H5Target> columns{
      h5_target("depth", labels.depth), h5_target("flow_x", labels.flow_x),
      h5_target("flow_y", labels.flow_y), h5_target("object", labels.object),
      h5_target("origin", labels.origin)};
  const bool has_instances = has_h5_column(file, kLabelsGroup, "instance");
  if (has_instances) {
    columns.push_back(h5_target("instance", labels.instance));
    columns.push_back(h5_target("class", labels.class_id));
  }
  read_h5_table(file, kLabelsGroup, count, begin, columns);
  if (!has_instances) take_objects_for_instances(labels);
  return labels;
}

}  // namespace saccade
