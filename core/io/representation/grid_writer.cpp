#include "core/io/representation/grid_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <span>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/images/image_file.h"
#include "core/io/tables/npy_header.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

constexpr const char* kWindowsHeader = "# from to events\n";

void append_line(const GridWindow& window, std::string& text) {
  append_decimal_seconds(window.from_ns, text);
  text += ' ';
  append_decimal_seconds(window.to_ns, text);
  text += fmt::format(" {}\n", window.last - window.first);
}

std::uint64_t size(int side) { return static_cast<std::uint64_t>(side); }

class NpyGridWriter final : public GridWriter {
 public:
  NpyGridWriter(const fs::path& file, const GridShape& shape)
      : shape_(shape), file_(file), stream_(file_.path(), std::ios::binary) {
    stream_ << npy_header_text(
        "<f4", {shape.count, size(shape.channels), size(shape.height), size(shape.width)});
  }

  void append(const EventGrid& grid, const GridWindow& window) override {
    SACCADE_CHECK(grid.size() == shape_.size());
    stream_.write(reinterpret_cast<const char*>(grid.data()),
                  static_cast<std::streamsize>(grid.size() * sizeof(float)));
    append_line(window, windows_);
    ++count_;
  }

  void close() override {
    SACCADE_CHECK(count_ == shape_.count);
    stream_.close();
    if (!stream_) fail_to_write(file_.target(), errno);
    write_atomically(file_.target().string() + ".windows.txt", windows_);
    file_.commit();
  }

 private:
  GridShape shape_;
  AtomicFile file_;
  std::ofstream stream_;
  std::string windows_ = kWindowsHeader;
  std::size_t count_ = 0;
};

class PngGridWriter final : public GridWriter {
 public:
  PngGridWriter(const fs::path& folder, const GridShape& shape, float scale)
      : shape_(shape), scale_(scale), folder_(folder, "windows.txt") {}

  void append(const EventGrid& grid, const GridWindow& window) override {
    SACCADE_CHECK(grid.size() == shape_.size());
    const fs::path file = folder_.path() / fmt::format("frame_{:08}.png", count_++);
    if (shape_.channels == 1) {
      ImageU8 image(shape_.width, shape_.height);
      for (std::size_t i = 0; i < image.size(); ++i) image.pixels()[i] = code(grid[i]);
      write_png(file, image);
    } else {
      ImageRgb8 image(shape_.width, shape_.height);
      for (std::size_t i = 0; i < image.size(); ++i)
        image.pixels()[i] = {code(grid[i]), 0, code(grid[image.size() + i])};
      write_png(file, image);
    }
    append_line(window, windows_);
  }

  void close() override {
    SACCADE_CHECK(count_ == shape_.count);
    write_atomically(folder_.path() / "windows.txt", windows_);
    folder_.commit();
  }

 private:
  [[nodiscard]] std::uint8_t code(float value) const {
    return static_cast<std::uint8_t>(std::clamp(std::round(scale_ * value), 0.0F, 255.0F));
  }

  GridShape shape_;
  float scale_;
  AtomicFolder folder_;
  std::string windows_ = kWindowsHeader;
  std::size_t count_ = 0;
};

}  // namespace

std::unique_ptr<GridWriter> make_npy_grid_writer(const fs::path& file, const GridShape& shape) {
  return std::make_unique<NpyGridWriter>(file, shape);
}

std::unique_ptr<GridWriter> make_png_grid_writer(const fs::path& folder, const GridShape& shape,
                                                 float png_scale) {
  if (shape.channels > 2)
    throw InputError(
        folder.string(),
        fmt::format("grids of {} channels are no pictures; write .h5 or .npy", shape.channels));
  return std::make_unique<PngGridWriter>(folder, shape, png_scale);
}

std::unique_ptr<GridWriter> make_grid_writer(const fs::path& output, const GridShape& shape,
                                             float png_scale) {
  const std::string ending = output.extension().string();
  if (ending == ".h5" || ending == ".hdf5") return make_h5_grid_writer(output, shape);
  if (ending == ".npy") return make_npy_grid_writer(output, shape);
  if (ending.empty()) return make_png_grid_writer(output, shape, png_scale);
  throw InputError(output.string(),
                   "cannot tell the format from the ending; valid endings of grids: .h5, .hdf5, "
                   ".npy; none: a folder of pictures");
}

}  // namespace saccade
