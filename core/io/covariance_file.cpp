#include "core/io/covariance_file.h"

#include <fmt/format.h>

#include <string>

#include "core/error.h"
#include "core/event.h"
#include "core/io/files/atomic_file.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace {

constexpr const char* kCovarianceColumns =
    "t vx_vx vx_vy vx_vz vx_wx vx_wy vx_wz vy_vy vy_vz vy_wx vy_wy vy_wz vz_vz vz_wx vz_wy vz_wz "
    "wx_wx wx_wy wx_wz wy_wy wy_wz wz_wz";

}  // namespace

void write_covariances(const std::filesystem::path& file,
                       std::span<const StampedCovariance> covariances) {
  std::string text = fmt::format("# {}\n", kCovarianceColumns);
  for (const StampedCovariance& entry : covariances) {
    append_decimal_seconds(ns_from_seconds(entry.t_s), text);
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        text += fmt::format(" {}", entry.covariance(row, column));
    text += '\n';
  }
  write_atomically(file, text);
}

std::vector<StampedCovariance> read_covariances(const std::filesystem::path& file) {
  const NumberTable table = read_number_table(file, kCovarianceColumns);
  std::vector<StampedCovariance> covariances;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    StampedCovariance entry;
    entry.t_s = table(i, 0);
    if (!covariances.empty() && !(entry.t_s > covariances.back().t_s))
      throw InputError(table.place(i), "times must increase");
    std::size_t column = 1;
    for (int a = 0; a < 6; ++a)
      for (int b = a; b < 6; ++b)
        entry.covariance(a, b) = entry.covariance(b, a) = table(i, column++);
    covariances.push_back(entry);
  }
  return covariances;
}

}  // namespace saccade
