#include "core/io/import/disparity_picture.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "core/error.h"
#include "core/io/files/file_bytes.h"

namespace saccade {

Image<std::uint16_t> read_16bit_picture(const std::filesystem::path& file) {
  auto bytes = read_file_bytes(file);
  cv::Mat mat;
  try {
    if (!bytes.empty())
      mat = cv::imdecode(cv::Mat(1, static_cast<int>(bytes.size()), CV_8UC1, bytes.data()),
                         cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    mat.release();  // a broken header; the message below says so
  }
  if (mat.type() != CV_16UC1 || mat.empty())
    throw InputError(file.string(), "is no 16-bit grey picture");
  Image<std::uint16_t> image(mat.cols, mat.rows);
  for (int y = 0; y < mat.rows; ++y) std::copy_n(mat.ptr<std::uint16_t>(y), mat.cols, &image(0, y));
  return image;
}

}  // namespace saccade
