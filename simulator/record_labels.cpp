#include "simulator/record_labels.h"

#include <utility>
#include <vector>

#include "core/io/labels/box_file.h"
#include "core/io/labels/label_images.h"
#include "core/io/labels/label_record.h"
#include "core/io/labels/optical_flow_file.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "simulator/sensor/labels/label_renderer.h"
#include "simulator/sensor/labels/optical_flow_renderer.h"
#include "simulator/sensor/sample_times.h"

namespace saccade {
namespace {

LabelRecord label_record(const Scene& scene, const SceneOptions& options) {
  LabelRecord record;
  for (const std::string& name : class_names(options))
    record.classes.push_back({static_cast<std::int64_t>(record.classes.size() + 1), name});
  for (const SceneInstance& instance : scene.instances())
    record.instances.push_back({static_cast<std::int64_t>(record.instances.size() + 1),
                                instance.name, instance.class_id, instance.object, instance.file});
  return record;
}

/// At the frames and at a rate; none at rate 0.
std::vector<TimeNs> label_times(const CameraRecording& recording, double rate_hz) {
  if (rate_hz <= 0) return {};
  return merge_times(sample_times(recording.config.frames.rate_hz, recording.duration_s()),
                     sample_times(rate_hz, recording.duration_s()));
}

void record_masks(const CameraRecording& recording, const LabelRenderer& renderer,
                  const std::vector<TimeNs>& times, LabelImageWriter& writer) {
  Progress progress("masks", times.size(), "masks");
  std::vector<std::vector<InstanceBox>> boxes(times.size());
  parallel_for(times.size(), [&](std::size_t i) {
    const StampedPose pose = recording.pose(seconds_from_ns(times[i]));
    const InstanceMask mask = renderer.mask(pose);
    writer.write_mask(i, pose.t_s, mask);
    boxes[i] = renderer.boxes(pose, mask);
    progress.add(1);
  });
  std::vector<InstanceBox> all;
  for (const std::vector<InstanceBox>& of_one : boxes)
    all.insert(all.end(), of_one.begin(), of_one.end());
  write_boxes(recording.writer.folder() / "boxes.txt", all);
}

void record_normals(const CameraRecording& recording, const LabelRenderer& renderer,
                    const std::vector<TimeNs>& times, LabelImageWriter& writer) {
  Progress progress("normals", times.size(), "normal maps");
  parallel_for(times.size(), [&](std::size_t i) {
    const StampedPose pose = recording.pose(seconds_from_ns(times[i]));
    writer.write_normals(i, pose.t_s, renderer.normals(pose));
    progress.add(1);
  });
}

/// Over the intervals between consecutive times.
void record_optical_flow(const CameraRecording& recording, const std::vector<TimeNs>& times) {
  const OpticalFlowRenderer renderer(recording.scene, recording.camera);
  OpticalFlowWriter writer(recording.writer.folder());
  Progress progress("optical flow", times.size() - 1, "intervals");
  parallel_for(times.size() - 1, [&](std::size_t i) {
    const StampedPose first = recording.pose(seconds_from_ns(times[i]));
    const StampedPose second = recording.pose(seconds_from_ns(times[i + 1]));
    writer.write(i, first.t_s, second.t_s, renderer.pair(first, second));
    progress.add(1);
  });
  writer.finish();
}

}  // namespace

void record_labels(const CameraRecording& recording, DatasetRecord::Counts& counts) {
  const GroundtruthOptions& rates = recording.config.groundtruth;
  const std::vector<TimeNs> masks = label_times(recording, rates.masks_rate_hz);
  const std::vector<TimeNs> normals = label_times(recording, rates.normals_rate_hz);
  const std::vector<TimeNs> flows =
      sample_times(rates.optical_flow_rate_hz, recording.duration_s());
  const LabelRenderer renderer(recording.scene, recording.camera);
  LabelImageWriter writer(recording.writer.folder());
  if (!masks.empty()) record_masks(recording, renderer, masks, writer);
  if (!normals.empty()) record_normals(recording, renderer, normals, writer);
  if (flows.size() > 1) record_optical_flow(recording, flows);
  writer.finish();
  if (!masks.empty() || rates.event_labels)
    write_label_record(recording.writer.folder() / "labels.yaml",
                       label_record(recording.scene, recording.config.scene));
  counts.masks = static_cast<std::int64_t>(masks.size());
  counts.normal_maps = static_cast<std::int64_t>(normals.size());
  counts.optical_flows = flows.empty() ? 0 : static_cast<std::int64_t>(flows.size() - 1);
}

}  // namespace saccade
