#include "core/io/events/numpy/numpy_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "core/event.h"
#include "core/io/files/byte_reader.h"

namespace saccade {
namespace {

constexpr std::string_view kEnding = ".npy";

/// convert(number) of one field of every row.
template <class T, class Convert>
void read_field(std::span<const std::byte> rows, std::size_t row_bytes, std::size_t offset,
                std::vector<std::int64_t>& values, const Convert& convert) {
  values.resize(rows.size() / row_bytes);
  const std::byte* at = rows.data() + offset;
  for (std::int64_t& value : values) {
    value = convert(load<T>(at));
    at += row_bytes;
  }
}

/// Beyond the range: its ends; no number: the least of all.
std::int64_t rounded(double value) {
  constexpr double kMost = 9.2e18;
  if (std::isnan(value)) return std::numeric_limits<std::int64_t>::min();
  return static_cast<std::int64_t>(std::llround(std::clamp(value, -kMost, kMost)));
}

std::int64_t whole(std::uint64_t value) {
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return static_cast<std::int64_t>(std::min(value, kMost));
}

}  // namespace

void read_whole_numbers(std::span<const std::byte> rows, std::size_t row_bytes,
                        const NpyField& field, std::vector<std::int64_t>& values) {
  const auto as = [&]<class T>(T /*type*/) {
    read_field<T>(rows, row_bytes, field.offset, values, [](T value) -> std::int64_t {
      if constexpr (std::is_floating_point_v<T>)
        return rounded(std::trunc(double{value}));
      else if constexpr (std::is_same_v<T, std::uint64_t>)
        return whole(value);
      else
        return value;
    });
  };
  const NpyType& type = field.type;
  if (type.kind == 'f') return type.bytes == 4 ? as(float{}) : as(double{});
  const bool is_signed = type.kind == 'i';
  if (type.bytes == 1) return is_signed ? as(std::int8_t{}) : as(std::uint8_t{});
  if (type.bytes == 2) return is_signed ? as(std::int16_t{}) : as(std::uint16_t{});
  if (type.bytes == 4) return is_signed ? as(std::int32_t{}) : as(std::uint32_t{});
  return is_signed ? as(std::int64_t{}) : as(std::uint64_t{});
}

void read_seconds(std::span<const std::byte> rows, std::size_t row_bytes, const NpyField& field,
                  std::vector<std::int64_t>& values_ns) {
  const auto ns = [](auto t_s) { return rounded(double{t_s} / kSecondsPerNs); };
  if (field.type.bytes == 4)
    read_field<float>(rows, row_bytes, field.offset, values_ns, ns);
  else
    read_field<double>(rows, row_bytes, field.offset, values_ns, ns);
}

NumpyArray::NumpyArray(std::string location, Source source)
    : location_(std::move(location)), source_(std::move(source)) {
  std::string head(kNpyPrefixBytes, '\0');
  const auto fill = [&](std::size_t begin) {
    const auto bytes = std::as_writable_bytes(std::span(head)).subspan(begin);
    if (source_(bytes) < bytes.size()) throw NpyError{"the file ends within the header"};
  };
  try {
    fill(0);
    head.resize(npy_header_bytes(head));
    fill(kNpyPrefixBytes);
    header_ = parse_npy_header(head);
  } catch (const NpyError& error) {
    throw InputError(location_, error.problem);
  }
  row_bytes_ = header_.item_bytes;
}

std::span<const std::byte> NumpyArray::read(std::size_t most) {
  if (!header_.fields.empty())
    if (const char kind = header_.fields.front().type.kind; kind == 'U' || kind == 'V')
      throw InputError(location_, "holds text or raw bytes where numbers are expected");
  return read_rows(most);
}

std::span<const std::byte> NumpyArray::read_rows(std::size_t most) {
  // A claimed row may be as long as it likes, a block of them may not.
  constexpr std::size_t kMostBlockBytes = std::size_t{1} << 26U;
  most = std::min(most,
                  std::max<std::size_t>(1, kMostBlockBytes / std::max<std::size_t>(1, row_bytes_)));
  const std::uint64_t rows = std::min<std::uint64_t>(most, this->rows() - done_);
  block_.resize(static_cast<std::size_t>(rows) * row_bytes_);
  const std::size_t filled = source_(block_);
  if (filled < block_.size())
    throw InputError(location_, fmt::format("ends within row {} of the {} that its header states",
                                            done_ + filled / row_bytes_, this->rows()));
  done_ += rows;
  return block_;
}

std::string NumpyArray::text() {
  std::string result;
  const NpyType type = header_.fields.front().type;
  if (type.kind != 'U' || !header_.shape.empty()) return result;
  const std::span<const std::byte> bytes = read_rows(1);
  for (std::size_t i = 0; i < bytes.size(); i += 4)
    if (bytes[i] != std::byte{0}) result += static_cast<char>(bytes[i]);
  return result;
}

NumpyFile::NumpyFile(const std::filesystem::path& file) : path_(file) {
  ByteReader bytes(file);
  const auto magic = bytes.peek(1);
  if (magic.empty() || magic.front() != std::byte{'P'}) return;
  archive_ = std::make_unique<ZipArchive>(file);
  for (const std::string& member : archive_->members())
    if (member.ends_with(kEnding))
      names_.push_back(member.substr(0, member.size() - kEnding.size()));
}

bool NumpyFile::contains(const std::string& name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

NumpyArray NumpyFile::open(const std::string& name) const {
  if (archive_ != nullptr) {
    const std::string member_name = name + std::string(kEnding);
    const auto member = std::make_shared<ZipMember>(*archive_, member_name);
    return {archive_->location(member_name),
            [member](std::span<std::byte> bytes) { return member->read(bytes); }};
  }
  const auto stream = std::make_shared<std::ifstream>(path_, std::ios::binary);
  return {path_.string(), [stream](std::span<std::byte> bytes) {
            stream->read(reinterpret_cast<char*>(bytes.data()),
                         static_cast<std::streamsize>(bytes.size()));
            return static_cast<std::size_t>(stream->gcount());
          }};
}

}  // namespace saccade
