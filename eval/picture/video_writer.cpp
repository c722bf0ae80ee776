#include "eval/picture/video_writer.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "core/check.h"
#include "core/error.h"

extern char** environ;  // NOLINT: the standard name of the environment

namespace saccade {
namespace {

std::filesystem::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::filesystem::path program = std::filesystem::path(folder) / name;
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  throw InputError(name,
                   "is not on the PATH, but encodes the video; install it (Debian: apt-get "
                   "install ffmpeg) or write a .png");
}

std::vector<std::string> arguments_for(const std::filesystem::path& file, int width, int height,
                                       double fps, int crf) {
  // Frames of odd size get one more row or column: H.264 halves the resolution of colour.
  return {"ffmpeg",      "-y",
          "-loglevel",   "error",
          "-f",          "rawvideo",
          "-pix_fmt",    "rgb24",
          "-video_size", fmt::format("{}x{}", width, height),
          "-framerate",  fmt::format("{}", fps),
          "-i",          "pipe:0",
          "-vf",         "pad=ceil(iw/2)*2:ceil(ih/2)*2",
          "-c:v",        "libx264",
          "-crf",        std::to_string(crf),
          "-preset",     "medium",
          "-pix_fmt",    "yuv420p",
          "-movflags",   "+faststart",
          "-f",          "mp4",
          file.string()};
}

/// Starts the program with `input` as its standard input and returns its process id.
int start(const std::filesystem::path& program, std::vector<std::string> arguments, int input) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  pid_t process = -1;
  const int error = posix_spawn(&process, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw InputError(program.string(), "cannot be started");
  return process;
}

}  // namespace

VideoWriter::VideoWriter(const std::filesystem::path& file, int width, int height, double fps,
                         int crf)
    : file_(file), width_(width), height_(height) {
  SACCADE_CHECK(width > 0 && height > 0 && fps > 0 && crf >= 0 && crf <= 51);
  const std::filesystem::path program = find_program("ffmpeg");
  // A socket instead of a pipe: when ffmpeg dies, send() returns an error and no signal is raised.
  int ends[2];
  SACCADE_CHECK(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0);
  socket_ = ends[0];
  try {
    process_ = start(program, arguments_for(file_.path(), width, height, fps, crf), ends[1]);
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
}

VideoWriter::~VideoWriter() {
  if (socket_ >= 0) close(socket_);
  if (process_ >= 0) (void)wait_for_success();
}

void VideoWriter::add(const ImageRgb8& frame) {
  SACCADE_CHECK(frame.width() == width_ && frame.height() == height_ && socket_ >= 0);
  const char* bytes = reinterpret_cast<const char*>(frame.data());
  std::size_t left = frame.size() * sizeof(Rgb8);
  while (left > 0) {
    const ssize_t sent = send(socket_, bytes, left, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) fail();
    bytes += sent;
    left -= static_cast<std::size_t>(sent);
  }
}

void VideoWriter::finish() {
  close(socket_);
  socket_ = -1;
  if (!wait_for_success()) fail();
  file_.commit();
}

bool VideoWriter::wait_for_success() {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void VideoWriter::fail() const {
  throw InputError(file_.target().string(), "ffmpeg could not encode it; its message stands above");
}

}  // namespace saccade
