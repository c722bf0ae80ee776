#include "core/io/imu_file.h"

#include <fmt/format.h>

#include <array>

#include "core/config/config.h"
#include "core/io/files/atomic_file.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace {

using Names = std::array<const char*, 3>;

constexpr const char* kReading = "t ax ay az gx gy gz";
constexpr const char* kGyroBias = "t bx by bz sigma at_rest";
constexpr const char* kTruth = "t ax ay az gx gy gz bax bay baz bgx bgy bgz";

Eigen::Vector3d read_vector(TextRow& row, const Names& names) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = row.number(names[static_cast<std::size_t>(i)]);
  return v;
}

ImuSample read_sample(TextRow& row) {
  ImuSample sample;
  sample.t_ns = row.seconds("t");
  sample.specific_force = read_vector(row, {"ax", "ay", "az"});
  sample.angular_velocity = read_vector(row, {"gx", "gy", "gz"});
  return sample;
}

void expect_later(const TextRow& row, TimeNs before, TimeNs now) {
  if (now > before) return;
  row.fail(fmt::format("times must increase: {:.9f} s after {:.9f} s", seconds_from_ns(now),
                       seconds_from_ns(before)));
}

/// No sensor of a camera reads as much, and one such number spoils every filter after it.
void expect_plausible(const TextRow& row, const ImuSample& sample) {
  constexpr double kMostForce = 1e4;  // a thousand times gravity [m/s^2]
  constexpr double kMostRate = 1e3;   // [rad/s]
  if (!(sample.specific_force.cwiseAbs().maxCoeff() <= kMostForce))
    row.fail(fmt::format("a specific force beyond {:.0f} m/s^2; are its units m/s^2?", kMostForce));
  if (!(sample.angular_velocity.cwiseAbs().maxCoeff() <= kMostRate))
    row.fail(
        fmt::format("an angular velocity beyond {:.0f} rad/s; are its units rad/s?", kMostRate));
}

/// A space and the three numbers, each in the shortest form that reads back exactly.
void append(fmt::memory_buffer& text, const Eigen::Vector3d& v) {
  fmt::format_to(std::back_inserter(text), " {} {} {}", v.x(), v.y(), v.z());
}

void append(fmt::memory_buffer& text, const ImuSample& sample) {
  text.append(decimal_seconds(sample.t_ns));
  append(text, sample.specific_force);
  append(text, sample.angular_velocity);
}

}  // namespace

std::vector<ImuSample> read_imu(const std::filesystem::path& file) {
  std::vector<ImuSample> samples;
  for_each_row(file, [&](TextRow& row) {
    const ImuSample sample = read_sample(row);
    if (!samples.empty()) expect_later(row, samples.back().t_ns, sample.t_ns);
    row.expect_end(kReading);
    expect_plausible(row, sample);
    samples.push_back(sample);
    return true;
  });
  return samples;
}

void write_imu(const std::filesystem::path& file, std::span<const ImuSample> samples) {
  fmt::memory_buffer text;
  for (const ImuSample& sample : samples) {
    append(text, sample);
    text.push_back('\n');
  }
  write_atomically(file, {text.data(), text.size()});
}

std::vector<ImuTruth> read_imu_truth(const std::filesystem::path& file) {
  std::vector<ImuTruth> truth;
  for_each_row(file, [&](TextRow& row) {
    ImuTruth one;
    one.ideal = read_sample(row);
    if (!truth.empty()) expect_later(row, truth.back().ideal.t_ns, one.ideal.t_ns);
    one.accel_bias = read_vector(row, {"bax", "bay", "baz"});
    one.gyro_bias = read_vector(row, {"bgx", "bgy", "bgz"});
    row.expect_end(kTruth);
    truth.push_back(one);
    return true;
  });
  return truth;
}

void write_imu_truth(const std::filesystem::path& file, std::span<const ImuTruth> truth) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "# {}\n", kTruth);
  for (const ImuTruth& one : truth) {
    append(text, one.ideal);
    append(text, one.accel_bias);
    append(text, one.gyro_bias);
    text.push_back('\n');
  }
  write_atomically(file, {text.data(), text.size()});
}

std::vector<GyroBiasEstimate> read_gyro_biases(const std::filesystem::path& file) {
  std::vector<GyroBiasEstimate> biases;
  for_each_row(file, [&](TextRow& row) {
    GyroBiasEstimate one;
    one.t_ns = row.seconds("t");
    if (!biases.empty()) expect_later(row, biases.back().t_ns, one.t_ns);
    one.bias = read_vector(row, {"bx", "by", "bz"});
    one.sigma = row.number("sigma");
    const std::int64_t at_rest = row.integer("at_rest");
    if (at_rest != 0 && at_rest != 1) row.fail("at_rest must be 0 or 1");
    one.at_rest = at_rest == 1;
    row.expect_end(kGyroBias);
    biases.push_back(one);
    return true;
  });
  return biases;
}

void write_gyro_biases(const std::filesystem::path& file,
                       std::span<const GyroBiasEstimate> biases) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "# {}\n", kGyroBias);
  for (const GyroBiasEstimate& one : biases) {
    text.append(decimal_seconds(one.t_ns));
    append(text, one.bias);
    fmt::format_to(std::back_inserter(text), " {} {}\n", one.sigma, one.at_rest ? 1 : 0);
  }
  write_atomically(file, {text.data(), text.size()});
}

static void describe(config::Fields& fields, ImuCalibration& imu) {
  fields.value("accelerometer_noise_density", imu.accelerometer.density, "[m/s^2/sqrt(Hz)]")
      .required()
      .at_least(0);
  fields.value("accelerometer_random_walk", imu.accelerometer.random_walk, "[m/s^3/sqrt(Hz)]")
      .required()
      .at_least(0);
  fields.value("gyroscope_noise_density", imu.gyroscope.density, "[rad/s/sqrt(Hz)]")
      .required()
      .at_least(0);
  fields.value("gyroscope_random_walk", imu.gyroscope.random_walk, "[rad/s^2/sqrt(Hz)]")
      .required()
      .at_least(0);
  std::string topic = "/imu0";
  fields.value("rostopic", topic, "where Kalibr looks for the readings");
  fields.value("update_rate", imu.rate_hz, "[Hz]").required().above(0);
}

ImuCalibration read_imu_yaml(const std::filesystem::path& file) {
  return config::read<ImuCalibration>(config::load(file));
}

void write_imu_yaml(const std::filesystem::path& file, const ImuCalibration& imu) {
  write_atomically(file, config::print(imu));
}

}  // namespace saccade
