#include <array>
#include <cstdint>
#include <vector>

#include "core/check.h"
#include "core/io/files/atomic_file.h"
#include "core/io/representation/grid_writer.h"
#include "core/io/tables/h5_column.h"
#include "core/io/tables/h5_handle.h"

namespace saccade {
namespace {

class H5GridWriter final : public GridWriter {
 public:
  H5GridWriter(const std::filesystem::path& file, const GridShape& shape)
      : shape_(shape), target_(file) {
    const H5Lock lock;
    file_ = {H5Fcreate(target_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
    check_h5_write(file_.valid(), target_.target());
    const std::array<hsize_t, 4> size = extent(shape.count);
    const H5Handle space = {H5Screate_simple(4, size.data(), nullptr), H5Sclose};
    const H5Handle layout = {H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
    H5Pset_obj_track_times(layout, false);  // the same values give the same bytes
    if (shape.count > 0) {
      const std::array<hsize_t, 4> chunk = extent(1);
      H5Pset_chunk(layout, 4, chunk.data());
      H5Pset_shuffle(layout);
      H5Pset_deflate(layout, 1);
    }
    grids_ = {H5Dcreate2(file_, shape.name.c_str(), H5T_IEEE_F32LE, space, H5P_DEFAULT, layout,
                         H5P_DEFAULT),
              H5Dclose};
    check_h5_write(grids_.valid(), target_.target());
  }

  void append(const EventGrid& grid, const GridWindow& window) override {
    SACCADE_CHECK(grid.size() == shape_.size() && from_s_.size() < shape_.count);
    const H5Lock lock;
    const std::array<hsize_t, 4> first{from_s_.size(), 0, 0, 0};
    const std::array<hsize_t, 4> size = extent(1);
    const H5Handle space = {H5Dget_space(grids_), H5Sclose};
    const H5Handle memory = {H5Screate_simple(4, size.data(), nullptr), H5Sclose};
    H5Sselect_hyperslab(space, H5S_SELECT_SET, first.data(), nullptr, size.data(), nullptr);
    check_h5_write(H5Dwrite(grids_, H5T_NATIVE_FLOAT, memory, space, H5P_DEFAULT, grid.data()) >= 0,
                   target_.target());
    from_s_.push_back(seconds_from_ns(window.from_ns));
    to_s_.push_back(seconds_from_ns(window.to_ns));
    events_.push_back(window.last - window.first);
  }

  void close() override {
    SACCADE_CHECK(from_s_.size() == shape_.count);
    const H5Lock lock;
    write_column("from", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, from_s_.data());
    write_column("to", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, to_s_.data());
    write_column("events", H5T_STD_U64LE, H5T_NATIVE_UINT64, events_.data());
    const bool closed = grids_.close();
    check_h5_write(file_.close() && closed, target_.target());
    target_.commit();
  }

 private:
  [[nodiscard]] std::array<hsize_t, 4> extent(std::size_t count) const {
    return {count, static_cast<hsize_t>(shape_.channels), static_cast<hsize_t>(shape_.height),
            static_cast<hsize_t>(shape_.width)};
  }

  void write_column(const char* name, hid_t file_type, hid_t memory_type, const void* values) {
    const hsize_t size = shape_.count;
    const H5Handle space = {H5Screate_simple(1, &size, nullptr), H5Sclose};
    const H5Handle layout = {H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
    H5Pset_obj_track_times(layout, false);
    H5Handle column = {H5Dcreate2(file_, name, file_type, space, H5P_DEFAULT, layout, H5P_DEFAULT),
                       H5Dclose};
    const bool is_written =
        column.valid() &&
        (size == 0 || H5Dwrite(column, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    check_h5_write(column.close() && is_written, target_.target());
  }

  GridShape shape_;
  AtomicFile target_;
  H5Handle file_, grids_;
  std::vector<double> from_s_, to_s_;
  std::vector<std::uint64_t> events_;
};

}  // namespace

std::unique_ptr<GridWriter> make_h5_grid_writer(const std::filesystem::path& file,
                                                const GridShape& shape) {
  return std::make_unique<H5GridWriter>(file, shape);
}

}  // namespace saccade
