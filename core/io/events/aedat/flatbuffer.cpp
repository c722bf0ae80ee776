#include "core/io/events/aedat/flatbuffer.h"

#include <fmt/format.h>

namespace saccade {
namespace {

using Offset = std::uint32_t;
constexpr std::size_t kIdentifierBytes = 4;

}  // namespace

FlatTable FlatTable::root(std::span<const std::byte> sized, std::string_view identifier) {
  constexpr std::size_t kLeast = 2 * sizeof(Offset) + kIdentifierBytes;
  if (sized.size() < kLeast) throw FlatBufferError{"the buffer is shorter than its head"};
  if (load<Offset>(sized.data()) != sized.size() - sizeof(Offset))
    throw FlatBufferError{fmt::format("the buffer states a size of {} bytes, but has {}",
                                      load<Offset>(sized.data()), sized.size() - sizeof(Offset))};
  const std::span<const std::byte> buffer = sized.subspan(sizeof(Offset));
  const std::string_view found(reinterpret_cast<const char*>(buffer.data() + sizeof(Offset)),
                               kIdentifierBytes);
  if (found != identifier)
    throw FlatBufferError{fmt::format("the buffer is not of the type {}", identifier)};
  return {buffer, load<Offset>(buffer.data())};
}

FlatTable::FlatTable(std::span<const std::byte> buffer, std::size_t at) : buffer_(buffer), at_(at) {
  const auto back = value<std::int32_t>(at);
  const auto table = static_cast<std::int64_t>(at) - back;
  if (table < 0) throw FlatBufferError{"the list of fields lies outside the buffer"};
  const auto list = static_cast<std::size_t>(table);
  fields_ = list + 2 * sizeof(std::uint16_t);
  fields_end_ = list + value<std::uint16_t>(list);
  static_cast<void>(part(list, fields_end_ - list));
}

std::span<const std::byte> FlatTable::part(std::size_t at, std::size_t size) const {
  if (at > buffer_.size() || size > buffer_.size() - at)
    throw FlatBufferError{fmt::format("an offset leads to byte {} of {}", at, buffer_.size())};
  return buffer_.subspan(at, size);
}

std::size_t FlatTable::place(unsigned field) const {
  const std::size_t at = fields_ + field * sizeof(std::uint16_t);
  if (at + sizeof(std::uint16_t) > fields_end_) return 0;
  const auto offset = value<std::uint16_t>(at);
  return offset == 0 ? 0 : at_ + offset;
}

std::span<const std::byte> FlatTable::structs(unsigned field, std::size_t item_bytes) const {
  const std::size_t at = place(field);
  if (at == 0) return {};
  const std::size_t vector = at + value<Offset>(at);
  return part(vector + sizeof(Offset), value<Offset>(vector) * item_bytes);
}

std::vector<FlatTable> FlatTable::tables(unsigned field) const {
  const std::span<const std::byte> offsets = structs(field, sizeof(Offset));
  std::vector<FlatTable> list;
  list.reserve(offsets.size() / sizeof(Offset));
  for (std::size_t i = 0; i < offsets.size(); i += sizeof(Offset)) {
    const auto from = static_cast<std::size_t>(offsets.data() + i - buffer_.data());
    list.push_back(FlatTable(buffer_, from + load<Offset>(offsets.data() + i)));
  }
  return list;
}

std::string_view FlatTable::text(unsigned field) const {
  const std::span<const std::byte> bytes = structs(field, 1);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace saccade
