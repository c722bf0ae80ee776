#include "core/io/images/image_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/file_bytes.h"
#include "core/io/images/dds_file.h"
#include "core/io/images/tga_file.h"

namespace saccade {
namespace {

cv::Mat decode(std::span<const std::byte> bytes, const std::string& location, int flags) {
  if (bytes.empty()) throw InputError(location, "is empty, not a picture");
  const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8UC1,
                        const_cast<std::byte*>(bytes.data()));
  cv::Mat decoded;
  try {
    decoded = cv::imdecode(encoded, flags);
  } catch (const cv::Exception&) {
    decoded.release();  // broken headers throw, broken pixels do not; both get the message below
  }
  if (decoded.empty())
    throw InputError(location, "is no picture that can be decoded, or is damaged");
  return decoded;
}

cv::Mat read(const std::filesystem::path& file, int flags) {
  return decode(read_file_bytes(file), file.string(), flags);
}

cv::Mat read_as(const std::filesystem::path& file, int type, const char* kind) {
  cv::Mat mat = read(file, cv::IMREAD_UNCHANGED);
  if (mat.type() != type) throw InputError(file.string(), std::string("is no picture of ") + kind);
  return mat;
}

template <class T>
Image<T> copied(const cv::Mat& mat) {
  SACCADE_CHECK(mat.elemSize() == sizeof(T));
  Image<T> image(mat.cols, mat.rows);
  for (int y = 0; y < mat.rows; ++y) std::copy_n(mat.ptr<T>(y), mat.cols, &image(0, y));
  return image;
}

ImageRgba8 rgba_from(cv::Mat mat) {
  if (mat.depth() == CV_16U) mat.convertTo(mat, CV_8U, 1.0 / 256);
  if (mat.depth() != CV_8U) mat.convertTo(mat, CV_8U, 255);
  const int code = mat.channels() == 1   ? cv::COLOR_GRAY2RGBA
                   : mat.channels() == 3 ? cv::COLOR_BGR2RGBA
                                         : cv::COLOR_BGRA2RGBA;
  cv::Mat rgba;
  cv::cvtColor(mat, rgba, code);
  return copied<Rgba8>(rgba);
}

bool is_named_tga(const std::string& location) {
  std::string ending = std::filesystem::path(location).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".tga";
}

/// KTX and KTX 2 begin alike.
bool is_ktx(std::span<const std::byte> bytes) {
  constexpr std::array<unsigned char, 5> kBegin{0xAB, 'K', 'T', 'X', ' '};
  return bytes.size() >= kBegin.size() &&
         std::ranges::equal(bytes.first(kBegin.size()), kBegin, [](std::byte a, unsigned char b) {
           return std::to_integer<unsigned char>(a) == b;
         });
}

std::string encode(const cv::Mat& mat) {
  std::vector<unsigned char> bytes;
  SACCADE_CHECK(cv::imencode(".png", mat, bytes));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

ImageU8 read_image_grey(const std::filesystem::path& file) {
  return copied<std::uint8_t>(read(file, cv::IMREAD_GRAYSCALE));
}

ImageRgb8 read_image_rgb(const std::filesystem::path& file) {
  cv::Mat rgb;
  cv::cvtColor(read(file, cv::IMREAD_COLOR), rgb, cv::COLOR_BGR2RGB);
  return copied<Rgb8>(rgb);
}

ImageU16 read_image_u16(const std::filesystem::path& file) {
  return copied<std::uint16_t>(read_as(file, CV_16UC1, "one channel of 16 bits"));
}

ImageRgb16 read_image_rgb16(const std::filesystem::path& file) {
  cv::Mat rgb;
  cv::cvtColor(read_as(file, CV_16UC3, "three channels of 16 bits"), rgb, cv::COLOR_BGR2RGB);
  return copied<Rgb16>(rgb);
}

ImageRgba8 read_image_rgba(const std::filesystem::path& file) {
  return decode_image_rgba(read_file_bytes(file), file.string());
}

ImageRgba8 decode_image_rgba(std::span<const std::byte> bytes, const std::string& location) {
  if (is_dds(bytes)) return decode_dds(bytes, location);
  if (is_ktx(bytes))
    throw InputError(location, "is a KTX picture, which cannot be decoded: convert it to PNG");
  if (is_named_tga(location)) return decode_tga(bytes, location);
  return rgba_from(decode(bytes, location, cv::IMREAD_UNCHANGED));
}

std::string encode_png(const ImageU8& image) {
  SACCADE_CHECK(!image.empty());
  return encode(
      cv::Mat(image.height(), image.width(), CV_8UC1, const_cast<std::uint8_t*>(image.data())));
}

std::string encode_png(const ImageRgb8& image) {
  SACCADE_CHECK(!image.empty());
  const cv::Mat rgb(image.height(), image.width(), CV_8UC3, const_cast<Rgb8*>(image.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return encode(bgr);
}

void write_png(const std::filesystem::path& file, const ImageU16& image) {
  SACCADE_CHECK(!image.empty());
  write_atomically(file, encode(cv::Mat(image.height(), image.width(), CV_16UC1,
                                        const_cast<std::uint16_t*>(image.data()))));
}

void write_png(const std::filesystem::path& file, const ImageRgb16& image) {
  SACCADE_CHECK(!image.empty());
  const cv::Mat rgb(image.height(), image.width(), CV_16UC3, const_cast<Rgb16*>(image.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  write_atomically(file, encode(bgr));
}

void write_png(const std::filesystem::path& file, const ImageU8& image) {
  write_atomically(file, encode_png(image));
}

void write_png(const std::filesystem::path& file, const ImageRgb8& image) {
  write_atomically(file, encode_png(image));
}

}  // namespace saccade
