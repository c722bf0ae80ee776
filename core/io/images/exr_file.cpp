#include "core/io/images/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/file_bytes.h"
#include "core/io/images/picture_bytes.h"
#include "core/srgb.h"

namespace saccade {
namespace {

/// Files are read whole and decoded from memory, so that every source takes the same path and a
/// file is never touched while OpenEXR holds it.
class MemoryStream final : public Imf::IStream {
 public:
  MemoryStream(std::span<const std::byte> bytes, const std::string& name)
      : IStream(name.c_str()), bytes_(bytes) {}

  bool read(char c[], int n) override {
    const std::size_t count = static_cast<std::size_t>(n);
    if (count > bytes_.size() - position_) throw std::runtime_error("the file ends too early");
    std::memcpy(c, bytes_.data() + position_, count);
    position_ += count;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("the file ends too early");
    position_ = position;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

/// Written to memory first, because OpenEXR does not report what fails when it closes a file.
class MemorySink final : public Imf::OStream {
 public:
  MemorySink() : OStream("memory") {}

  void write(const char c[], int n) override {
    const std::size_t end = position_ + static_cast<std::size_t>(n);
    if (end > bytes_.size()) bytes_.resize(end);
    bytes_.replace(position_, static_cast<std::size_t>(n), c, static_cast<std::size_t>(n));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

/// What the header states is compared with what follows, before memory is taken for it. Constant
/// planes are packed without a bound, but for the place of every 256 rows.
void check_exr_size(int width, int height, std::uint64_t channels, std::size_t file_bytes) {
  constexpr std::uint64_t kMostInflation = 4096;
  constexpr std::uint64_t kAlwaysAllowed = std::uint64_t{1} << 26U;  // pixels of all channels
  constexpr std::uint64_t kMostRowsOfAPlace = 256;
  constexpr std::uint64_t kPlaceBytes = 8;
  if (width < 1 || height < 1) throw std::runtime_error("it has no pixels");
  if (std::max(width, height) > static_cast<int>(kMostPictureSide))
    throw std::runtime_error(fmt::format("a side is longer than {} pixels", kMostPictureSide));
  const std::uint64_t rows = static_cast<std::uint64_t>(height);
  const std::uint64_t values = static_cast<std::uint64_t>(width) * rows * channels;
  if (rows / kMostRowsOfAPlace * kPlaceBytes > file_bytes ||
      values > kAlwaysAllowed + kMostInflation * file_bytes || values > 4 * kMostPixels)
    throw std::runtime_error(
        fmt::format("it states {} x {} pixels with {} channels, which {} bytes "
                    "cannot hold",
                    width, height, channels, file_bytes));
}

std::vector<ExrChannel> decode_channels(Imf::InputFile& file, std::size_t file_bytes) {
  const Imath::Box2i window = file.header().dataWindow();
  const std::int64_t stated_width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t stated_height = std::int64_t{window.max.y} - window.min.y + 1;
  constexpr std::int64_t kMostSide = kMostPictureSide;
  const int width = static_cast<int>(std::clamp<std::int64_t>(stated_width, 0, kMostSide + 1));
  const int height = static_cast<int>(std::clamp<std::int64_t>(stated_height, 0, kMostSide + 1));
  std::vector<ExrChannel> channels;
  const Imf::ChannelList& list = file.header().channels();
  std::uint64_t count = 0;
  for (auto it = list.begin(); it != list.end(); ++it) ++count;
  check_exr_size(width, height, count, file_bytes);
  for (auto it = list.begin(); it != list.end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      throw std::runtime_error(std::string("channel ") + it.name() + " is subsampled");
    channels.push_back({it.name(), ImageF(width, height)});
  }
  Imf::FrameBuffer buffer;
  for (ExrChannel& channel : channels) {
    buffer.insert(channel.name,
                  Imf::Slice::Make(Imf::FLOAT, channel.image.data(), window, sizeof(float),
                                   sizeof(float) * static_cast<std::size_t>(width)));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return channels;
}

std::vector<ExrChannel> decode(std::span<const std::byte> bytes, const std::string& location) {
  try {
    MemoryStream stream(bytes, location);
    Imf::InputFile file(stream, 0);
    return decode_channels(file, bytes.size());
  } catch (const std::exception& error) {
    throw InputError(location, std::string("is no OpenEXR picture or is damaged: ") + error.what());
  }
}

const ImageF* find(const std::vector<ExrChannel>& channels, const std::string& name) {
  for (const ExrChannel& channel : channels)
    if (channel.name == name) return &channel.image;
  return nullptr;
}

[[noreturn]] void fail_channels(const std::vector<ExrChannel>& channels,
                                const std::string& location, const std::string& wanted) {
  std::string names;
  for (const ExrChannel& channel : channels) names += " " + channel.name;
  throw InputError(location, "needs " + wanted + "; its channels are:" + names);
}

/// The plane that stands for the whole picture; nullptr when there is none.
const ImageF* single_plane(const std::vector<ExrChannel>& channels) {
  if (channels.size() == 1) return &channels.front().image;
  if (const ImageF* y = find(channels, "Y")) return y;
  return find(channels, "Z");
}

ImageRgbF rgb_from(const std::vector<ExrChannel>& channels, const std::string& location) {
  const ImageF* r = find(channels, "R");
  const ImageF* g = find(channels, "G");
  const ImageF* b = find(channels, "B");
  if (r == nullptr || g == nullptr || b == nullptr) r = g = b = single_plane(channels);
  if (r == nullptr) fail_channels(channels, location, "channels R, G and B or a single one");
  ImageRgbF image(r->width(), r->height());
  for (std::size_t i = 0; i < image.size(); ++i)
    image.pixels()[i] = {r->pixels()[i], g->pixels()[i], b->pixels()[i]};
  return image;
}

std::vector<ExrChannel> read_and_decode(const std::filesystem::path& file) {
  return decode(read_file_bytes(file), file.string());
}

}  // namespace

std::vector<ExrChannel> read_exr_channels(const std::filesystem::path& file) {
  return read_and_decode(file);
}

ImageF read_exr(const std::filesystem::path& file) {
  const std::vector<ExrChannel> channels = read_and_decode(file);
  if (const ImageF* plane = single_plane(channels)) return *plane;
  const ImageRgbF rgb = rgb_from(channels, file.string());
  ImageF grey(rgb.width(), rgb.height());
  std::transform(rgb.pixels().begin(), rgb.pixels().end(), grey.pixels().begin(),
                 [](const RgbF& c) { return luminance(c[0], c[1], c[2]); });
  return grey;
}

ImageRgbF read_exr_rgb(const std::filesystem::path& file) {
  return rgb_from(read_and_decode(file), file.string());
}

ImageRgbF decode_exr_rgb(std::span<const std::byte> bytes, const std::string& location) {
  return rgb_from(decode(bytes, location), location);
}

void write_exr(const std::filesystem::path& file, std::span<const ExrChannel> channels) {
  SACCADE_CHECK(!channels.empty());
  const int width = channels.front().image.width();
  const int height = channels.front().image.height();
  SACCADE_CHECK(width > 0 && height > 0);
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  for (const auto& [name, image] : channels) {
    SACCADE_CHECK(image.width() == width && image.height() == height);
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    buffer.insert(name,
                  Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(image.data())),
                             sizeof(float), sizeof(float) * static_cast<std::size_t>(width)));
  }
  MemorySink sink;
  {
    Imf::OutputFile output(sink, header, 0);
    output.setFrameBuffer(buffer);
    output.writePixels(height);
  }
  write_atomically(file, sink.bytes());
}

void write_exr(const std::filesystem::path& file, const ImageF& image, const std::string& channel) {
  write_exr(file, std::vector<ExrChannel>{{channel, image}});
}

void write_exr(const std::filesystem::path& file, const ImageRgbF& image) {
  std::vector<ExrChannel> channels;
  for (const std::size_t c : {0U, 1U, 2U}) {
    ExrChannel channel{std::string(1, "RGB"[c]), ImageF(image.width(), image.height())};
    std::transform(image.pixels().begin(), image.pixels().end(), channel.image.pixels().begin(),
                   [c](const RgbF& pixel) { return pixel[c]; });
    channels.push_back(std::move(channel));
  }
  write_exr(file, channels);
}

FlowField read_exr_flow(const std::filesystem::path& file) {
  const std::vector<ExrChannel> channels = read_and_decode(file);
  const ImageF* u = find(channels, "u");
  const ImageF* v = find(channels, "v");
  if (u == nullptr || v == nullptr) fail_channels(channels, file.string(), "channels u and v");
  return {*u, *v};
}

void write_exr_flow(const std::filesystem::path& file, const FlowField& flow) {
  write_exr(file, std::vector<ExrChannel>{{"u", flow.u}, {"v", flow.v}});
}

}  // namespace saccade
