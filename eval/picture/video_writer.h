#pragma once

#include <filesystem>

#include "core/image.h"
#include "core/io/files/atomic_file.h"

namespace saccade {

/// An H.264 MP4 file, encoded by the program ffmpeg, which receives the frames through a socket.
/// The file appears under its name when finish() has returned.
class VideoWriter {
 public:
  /// `crf`: H.264's constant rate factor, 0..51, more is smaller and worse. Throws InputError where
  /// ffmpeg is not on the PATH; `fps` > 0.
  VideoWriter(const std::filesystem::path& file, int width, int height, double fps, int crf);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// `frame` has the size given to the constructor (contract). Throws InputError when ffmpeg
  /// stopped early.
  void add(const ImageRgb8& frame);
  void finish();

 private:
  [[noreturn]] void fail() const;
  [[nodiscard]] bool wait_for_success();

  AtomicFile file_;
  int width_;
  int height_;
  int socket_ = -1;
  int process_ = -1;
};

}  // namespace saccade
