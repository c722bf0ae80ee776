#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "core/representation/event_window.h"
#include "core/representation/voxel_grid.h"

namespace saccade {

/// The arrays of a file: `count` grids of channels x height x width.
struct GridShape {
  std::string name;  ///< of the dataset in HDF5: voxel_grid, event_frame
  std::size_t count = 0;
  int channels = 0, height = 0, width = 0;

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(channels) * static_cast<std::size_t>(height) *
           static_cast<std::size_t>(width);
  }
};

/// Writes grids one by one. Nothing stands under the final name before close().
class GridWriter {
 public:
  virtual ~GridWriter() = default;
  virtual void append(const EventGrid& grid, const GridWindow& window) = 0;
  /// After `count` grids.
  virtual void close() = 0;
};

/// .h5 or .hdf5: /NAME (count x channels x height x width, float32), /from and /to [s] (float64) and
/// /events, their number (uint64).
///
/// .npy: the array alone, and beside it FILE.windows.txt: lines `from to events`.
///
/// A folder, for one or two channels: frame_%08d.png, 8 bits, and windows.txt. One channel is grey;
/// of two the first is red and the second blue. Values are multiplied by `png_scale`, rounded, and
/// saturate at 255.
[[nodiscard]] std::unique_ptr<GridWriter> make_h5_grid_writer(const std::filesystem::path& file,
                                                              const GridShape& shape);
[[nodiscard]] std::unique_ptr<GridWriter> make_npy_grid_writer(const std::filesystem::path& file,
                                                               const GridShape& shape);
[[nodiscard]] std::unique_ptr<GridWriter> make_png_grid_writer(const std::filesystem::path& folder,
                                                               const GridShape& shape,
                                                               float png_scale);

/// By the ending of `output`: HDF5, npy or, without an ending, a folder of pictures. InputError for
/// other endings, and for pictures of more than two channels.
[[nodiscard]] std::unique_ptr<GridWriter> make_grid_writer(const std::filesystem::path& output,
                                                           const GridShape& shape, float png_scale);

}  // namespace saccade
