#include "core/io/imu_file.h"

#include <fmt/format.h>

#include "core/io/atomic_file.h"
#include "core/io/text_table.h"

namespace saccade {
namespace {

constexpr const char* kAcceleration[] = {"ax", "ay", "az"};
constexpr const char* kRate[] = {"gx", "gy", "gz"};

}  // namespace

std::vector<ImuSample> read_imu(const std::filesystem::path& file) {
  std::vector<ImuSample> samples;
  for_each_row(file, [&](TextRow& row) {
    ImuSample sample;
    sample.t_ns = row.seconds("t");
    if (!samples.empty() && sample.t_ns <= samples.back().t_ns)
      row.fail(fmt::format("times must increase: {:.9f} s after {:.9f} s",
                           seconds_from_ns(sample.t_ns), seconds_from_ns(samples.back().t_ns)));
    for (int i = 0; i < 3; ++i) sample.specific_force[i] = row.number(kAcceleration[i]);
    for (int i = 0; i < 3; ++i) sample.angular_velocity[i] = row.number(kRate[i]);
    row.expect_end("t ax ay az gx gy gz");
    samples.push_back(sample);
    return true;
  });
  return samples;
}

void write_imu(const std::filesystem::path& file, std::span<const ImuSample> samples) {
  fmt::memory_buffer text;
  for (const ImuSample& s : samples)
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {}\n", decimal_seconds(s.t_ns),
                   s.specific_force.x(), s.specific_force.y(), s.specific_force.z(),
                   s.angular_velocity.x(), s.angular_velocity.y(), s.angular_velocity.z());
  write_atomically(file, {text.data(), text.size()});
}

}  // namespace saccade
