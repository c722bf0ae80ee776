#pragma once

#include "core/io/dataset/dataset_record.h"
#include "simulator/camera_recording.h"

namespace saccade {

/// Writes what is asked for of labels.yaml, masks with boxes.txt, normals and optical flow, in
/// parallel. Adds
/// their numbers to `counts`.
void record_labels(const CameraRecording& recording, DatasetRecord::Counts& counts);

}  // namespace saccade
