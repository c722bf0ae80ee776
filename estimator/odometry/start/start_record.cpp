#include "estimator/odometry/start/start_record.h"

#include "core/config/config.h"
#include "core/io/files/atomic_file.h"

namespace saccade {
namespace {

struct StartRecord {
  int format_version = 1;
  double depth_m = 1;
  double start_s = 0, end_s = 0;
  double parallax_px = 0;
  int edges = 0;
  double residual_px = 0;
};

void describe(config::Fields& fields, StartRecord& record) {
  fields.value("format_version", record.format_version, "layout of this file");
  fields.value("depth_m", record.depth_m, "the scale: the typical depth is called so");
  fields.value("start_s", record.start_s, "of the path; its first pose is the identity");
  fields.value("end_s", record.end_s, "of the path");
  fields.value("parallax_px", record.parallax_px, "of the typical depth, over the path");
  fields.value("edges", record.edges, "found with it");
  fields.value("residual_px", record.residual_px, "robust deviation of their events");
}

}  // namespace

void write_start(const std::filesystem::path& file, const Bootstrap& start, double depth_m) {
  StartRecord record;
  record.depth_m = depth_m;
  record.start_s = start.path.start_s();
  record.end_s = start.path.end_s();
  record.parallax_px = start.parallax_px;
  record.edges = static_cast<int>(start.edges);
  record.residual_px = start.residual_px;
  write_atomically(file, config::print(record));
}

}  // namespace saccade
