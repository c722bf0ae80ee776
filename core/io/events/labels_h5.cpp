#include "core/io/events/labels_h5.h"

#include <array>

#include "core/check.h"

namespace saccade {
namespace {

constexpr const char* kLabelsGroup = "labels";

std::array<H5Source, 5> columns_of(const EventLabels& labels) {
  return {h5_source("depth", labels.depth), h5_source("flow_x", labels.flow_x),
          h5_source("flow_y", labels.flow_y), h5_source("object", labels.object),
          h5_source("origin", labels.origin)};
}

}  // namespace

void EventLabels::resize(std::size_t count) {
  depth.resize(count);
  flow_x.resize(count);
  flow_y.resize(count);
  object.resize(count);
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
  const std::array<H5Target, 5> columns{
      h5_target("depth", labels.depth), h5_target("flow_x", labels.flow_x),
      h5_target("flow_y", labels.flow_y), h5_target("object", labels.object),
      h5_target("origin", labels.origin)};
  read_h5_table(file, kLabelsGroup, count, begin, columns);
  return labels;
}

}  // namespace saccade
