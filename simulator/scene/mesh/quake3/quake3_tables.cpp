#include "simulator/scene/mesh/quake3/quake3_tables.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "core/io/files/byte_reader.h"

namespace saccade {
namespace {

/// The tables that are read, by their place in the header.
enum class Lump : std::size_t {
  kEntities = 0,
  kShaders = 1,
  kModels = 7,
  kVertices = 10,
  kCorners = 11,
  kFaces = 13
};
constexpr std::size_t kLumps = 17;
constexpr std::size_t kLumpsBegin = 8;
constexpr std::size_t kLumpEntry = 8;  // offset and size

static_assert(sizeof(Quake3ShaderRow) == 72 && sizeof(Quake3ModelRow) == 40 &&
              sizeof(Quake3VertexRow) == 44 && sizeof(Quake3FaceRow) == 104);

std::span<const std::byte> bytes_of(std::span<const std::byte> file, Lump lump) {
  const auto index = static_cast<std::size_t>(lump);
  const std::byte* entry = file.data() + kLumpsBegin + kLumpEntry * index;
  const auto offset = load<std::uint32_t>(entry), size = load<std::uint32_t>(entry + 4);
  if (offset > file.size() || size > file.size() - offset)
    fail_as_damaged_map(fmt::format("its table {} ends behind the file", index));
  return file.subspan(offset, size);
}

template <class Row>
void read_rows(std::span<const std::byte> bytes, std::vector<Row>& rows) {
  rows.resize(bytes.size() / sizeof(Row));
  if (!rows.empty()) std::memcpy(rows.data(), bytes.data(), rows.size() * sizeof(Row));
}

}  // namespace

void fail_as_damaged_map(const std::string& what) {
  throw std::runtime_error("is a damaged map: " + what);
}

Quake3Tables read_quake3_tables(const Bytes& bytes) {
  const std::span<const std::byte> file = std::as_bytes(std::span(bytes));
  if (file.size() < kLumpsBegin + kLumpEntry * kLumps || std::memcmp(file.data(), "IBSP", 4) != 0)
    throw std::runtime_error("is no map of Quake III Arena: it does not begin with IBSP");
  const auto version = load<std::int32_t>(file.data() + 4);
  if (version != 46 && version != 47)
    throw std::runtime_error(
        fmt::format("is a map of version {}; those of Quake III Arena (46, 47) are read", version));
  Quake3Tables tables;
  const std::span<const std::byte> text = bytes_of(file, Lump::kEntities);
  tables.entities.assign(reinterpret_cast<const char*>(text.data()), text.size());
  tables.entities.resize(std::min(tables.entities.find('\0'), tables.entities.size()));
  read_rows(bytes_of(file, Lump::kShaders), tables.shaders);
  read_rows(bytes_of(file, Lump::kModels), tables.models);
  read_rows(bytes_of(file, Lump::kVertices), tables.vertices);
  read_rows(bytes_of(file, Lump::kCorners), tables.corners);
  read_rows(bytes_of(file, Lump::kFaces), tables.faces);
  return tables;
}

}  // namespace saccade
