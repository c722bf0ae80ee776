#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/io/tables/text_table.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

constexpr double kCsvUnitTolerance = 1e-3;

/// Columns of the time, the position and the quaternion x, y, z, w.
struct PoseColumns {
  std::array<std::size_t, 8> of{};
  std::size_t count = 0;  ///< of all columns
};

/// "q_RS_w []" -> "q_rs_w".
std::string plain_name(std::string_view cell) {
  cell = cell.substr(0, std::min(cell.find('['), cell.size()));
  std::string name;
  for (const char c : cell)
    if (std::isspace(static_cast<unsigned char>(c)) == 0 && c != '#')
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

/// Whether a column's name means the part `axis` of a position ('p') or quaternion ('q'): x, tx,
/// px, p_RS_R_x; qx, q_x, q_RS_x.
bool means(const std::string& name, char quantity, char axis) {
  if (name.empty() || name.back() != axis) return false;
  if (quantity == 'q') return name.front() == 'q';
  return name.size() == 1 || (name.size() == 2 && (name[0] == 't' || name[0] == 'p')) ||
         name.starts_with("p_");
}

/// nullopt where the line does not name all of them once.
std::optional<PoseColumns> parse_columns(std::string_view line) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    names.push_back(plain_name(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  PoseColumns columns;
  columns.count = names.size();
  constexpr std::array<std::pair<char, char>, 7> kParts{
      {{'p', 'x'}, {'p', 'y'}, {'p', 'z'}, {'q', 'x'}, {'q', 'y'}, {'q', 'z'}, {'q', 'w'}}};
  for (std::size_t part = 0; part < kParts.size(); ++part) {
    const auto [quantity, axis] = kParts[part];
    const auto is_it = [q = quantity, a = axis](const std::string& name) {
      return means(name, q, a);
    };
    const auto found = std::find_if(names.begin() + 1, names.end(), is_it);
    if (found == names.end() || std::find_if(found + 1, names.end(), is_it) != names.end())
      return std::nullopt;
    columns.of[part + 1] = static_cast<std::size_t>(found - names.begin());
  }
  return columns;
}

/// The columns that the first line that is not blank names; nullopt where it does not.
std::optional<PoseColumns> find_columns(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line) && plain_name(line).empty()) {
  }
  return parse_columns(line);
}

PoseColumns read_columns(const std::filesystem::path& file) {
  if (const auto columns = find_columns(file)) return *columns;
  throw InputError(file.string() + ":1",
                   "the first line must name the columns, because programs differ in the order of "
                   "the quaternion: \"# timestamp, x, y, z, qx, qy, qz, qw\" (rpg_esim), or with "
                   "\"qw, qx, qy, qz\" (EuRoC)");
}

StampedPose read_row(TextRow& row, const PoseColumns& columns) {
  const double t_s = seconds_from_ns(row.integer("timestamp"));
  std::vector<double> values{0};
  while (values.size() < columns.count) values.push_back(row.number("a column of the pose"));
  row.expect_end("what the first line names");
  const auto value = [&](std::size_t part) { return values[columns.of[part]]; };
  const Eigen::Quaterniond q(value(7), value(4), value(5), value(6));
  if (!(std::abs(q.norm() - 1) <= kCsvUnitTolerance))
    row.fail(fmt::format("the quaternion's length is {:.6g}; a rotation's is 1 (within {})",
                         q.norm(), kCsvUnitTolerance));
  return {t_s, {q, {value(1), value(2), value(3)}}};
}

}  // namespace

bool is_csv_trajectory(const std::filesystem::path& file) {
  // A line of another kind of file may be as long as the file.
  const bool may_be = file.extension() == ".csv" || file.extension() == ".txt";
  return may_be && std::filesystem::is_regular_file(file) && find_columns(file).has_value();
}

Trajectory read_csv_trajectory(const std::filesystem::path& file) {
  const PoseColumns columns = read_columns(file);
  std::vector<StampedPose> poses;
  TextReader reader(file);
  std::string_view line;
  for (bool first = true; reader.next(line); first = false) {
    if (first && parse_columns(line)) continue;
    TextRow row = reader.row(line);
    const StampedPose pose = read_row(row, columns);
    if (!poses.empty() && !(pose.t_s > poses.back().t_s))
      row.fail(
          fmt::format("times must increase: {:.9f} s after {:.9f} s", pose.t_s, poses.back().t_s));
    poses.push_back(pose);
  }
  if (poses.empty()) throw InputError(file.string(), "holds no poses");
  return Trajectory(std::move(poses));
}

}  // namespace saccade
