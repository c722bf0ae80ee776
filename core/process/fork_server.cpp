#include "core/process/fork_server.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace saccade {
namespace {

constexpr const char* kServerWord = "fork-server";
/// The server's socket is its input, so that nothing has to tell it a number.
constexpr int kServerSocket = STDIN_FILENO;
constexpr std::array kIgnored{SIGINT, SIGTERM, SIGHUP, SIGPIPE};

[[noreturn]] void fail_to_serve(const char* what, int error) {
  throw InputError("a process of its own",
                   fmt::format("{}: {}", what, std::generic_category().message(error)));
}

/// False where the other end is gone.
bool send_all(int descriptor, const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::send(descriptor, bytes, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int descriptor, void* data, std::size_t size) {
  char* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(descriptor, bytes, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

/// Room for one descriptor beside a message.
struct DescriptorMessage {
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  std::uint64_t size = 0;  ///< of the words that follow
  iovec part{&size, sizeof(size)};
  msghdr header{};

  DescriptorMessage() {
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
  }
};

/// A request is the size of its text, with the descriptor that is to hear of the end, and the text:
/// the log and the words, each ended by a zero.
bool send_request(int socket, const std::string& text, int end_pipe) {
  DescriptorMessage message;
  message.size = text.size();
  cmsghdr* const control = CMSG_FIRSTHDR(&message.header);
  control->cmsg_level = SOL_SOCKET;
  control->cmsg_type = SCM_RIGHTS;
  control->cmsg_len = CMSG_LEN(sizeof(int));
  std::memcpy(CMSG_DATA(control), &end_pipe, sizeof(int));
  ssize_t sent = 0;
  do sent = ::sendmsg(socket, &message.header, MSG_NOSIGNAL);
  while (sent < 0 && errno == EINTR);
  return sent == sizeof(message.size) && send_all(socket, text.data(), text.size());
}

struct Request {
  std::string log;
  std::vector<std::string> words;
  int end_pipe = -1;
};

/// False where the other end is gone.
bool receive_request(int socket, Request& request) {
  DescriptorMessage message;
  ssize_t got = 0;
  do got = ::recvmsg(socket, &message.header, MSG_CMSG_CLOEXEC | MSG_WAITALL);
  while (got < 0 && errno == EINTR);
  if (got != sizeof(message.size)) return false;
  const cmsghdr* const control = CMSG_FIRSTHDR(&message.header);
  if (control == nullptr || control->cmsg_type != SCM_RIGHTS) return false;
  std::memcpy(&request.end_pipe, CMSG_DATA(control), sizeof(int));
  std::string text(message.size, '\0');
  if (!receive_all(socket, text.data(), text.size())) return false;
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < text.size(); at += parts.back().size() + 1)
    parts.emplace_back(text.c_str() + at);
  if (parts.size() < 2) return false;
  request.log = parts.front();
  request.words.assign(parts.begin() + 1, parts.end());
  return true;
}

/// A command at work.
struct Served {
  pid_t process;
  int end_pipe;
};

/// /dev/null becomes the input, which closes the server's socket, and the log both outputs.
void open_streams(const std::string& log) {
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (nothing < 0 || file < 0) std::_Exit(1);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(file, STDOUT_FILENO);
  ::dup2(file, STDERR_FILENO);
  for (const int opened : {nothing, file})
    if (opened > STDERR_FILENO) ::close(opened);
}

[[noreturn]] void run_copy(const std::function<int(int, char**)>& command, const Request& request,
                           const std::vector<Served>& others) {
  ::setpgid(0, 0);
  ::close(request.end_pipe);
  for (const Served& other : others) ::close(other.end_pipe);
  open_streams(request.log);
  std::vector<std::string> words = request.words;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::exit(command(static_cast<int>(words.size()), arguments.data()));  // NOLINT: has one thread
}

/// Tells of every copy that has ended.
void tell_ends(std::vector<Served>& running) {
  int status = 0;
  rusage usage{};
  for (pid_t ended = 0; (ended = ::wait4(-1, &status, WNOHANG, &usage)) > 0;)
    for (auto one = running.begin(); one != running.end(); ++one)
      if (one->process == ended) {
        const ChildEnd end = ChildEnd::of(status, usage);
        // As short as this a message is written whole, or not at all where nobody waits for it.
        [[maybe_unused]] const ssize_t told = ::write(one->end_pipe, &end, sizeof(end));
        ::close(one->end_pipe);
        running.erase(one);
        break;
      }
}

/// False where no further requests come.
bool answer_request(const std::function<int(int, char**)>& command, std::vector<Served>& running) {
  Request request;
  if (!receive_request(kServerSocket, request)) return false;
  const pid_t process = ::fork();
  if (process == 0) run_copy(command, request, running);
  const std::int32_t answer = process > 0 ? process : -errno;
  if (process > 0) {
    ::setpgid(process, process);  // whoever is told of it may stop it at once
    running.push_back({process, request.end_pipe});
  } else {
    ::close(request.end_pipe);
  }
  return send_all(kServerSocket, &answer, sizeof(answer));
}

void nothing(int /*signal*/) {}

}  // namespace

bool is_fork_server(int argc, const char* const* argv) {
  return argc == 2 && std::string_view(argv[1]) == kServerWord;
}

int serve_forks(const std::function<int(int, char**)>& command) {
  int type = 0;
  socklen_t size = sizeof(type);
  if (::getsockopt(kServerSocket, SOL_SOCKET, SO_TYPE, &type, &size) != 0) {
    fmt::print(stderr, "saccade: {} is what sweeps call; there is no such verb\n", kServerWord);
    return 2;
  }
  // Ends are noticed between two looks alone, so that none slips by: a signal wakes ppoll().
  sigset_t child, before;
  sigemptyset(&child);
  sigaddset(&child, SIGCHLD);
  pthread_sigmask(SIG_BLOCK, &child, &before);
  struct sigaction wake {};
  wake.sa_handler = nothing;
  sigaction(SIGCHLD, &wake, nullptr);
  // It lives as long as its socket: a signal to all processes of a session is for its copies, which
  // end in good order, and it is to tell of that.
  for (const int ignored : kIgnored) ::signal(ignored, SIG_IGN);
  const auto restored = [&](int argc, char** argv) {
    ::signal(SIGCHLD, SIG_DFL);
    for (const int ignored : kIgnored) ::signal(ignored, SIG_DFL);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return command(argc, argv);
  };
  std::vector<Served> running;
  while (true) {
    pollfd requests{kServerSocket, POLLIN, 0};
    const int ready = ::ppoll(&requests, 1, nullptr, &before);
    tell_ends(running);
    if (ready > 0 && !answer_request(restored, running)) return 0;
  }
}

ForkServer::ForkServer(const std::filesystem::path& program) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    fail_to_serve("cannot be connected", errno);
  socket_ = ends[0];
  posix_spawn_file_actions_t files{};
  posix_spawnattr_t attributes{};
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[1], kServerSocket);
  // Whoever waits for the end of what this program prints does not wait for its copies.
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_init(&attributes);
  // In a group of its own: Ctrl-C in the terminal is this program's to answer.
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  posix_spawnattr_setpgroup(&attributes, 0);
  sigset_t all, none;
  sigfillset(&all);
  sigemptyset(&none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setsigmask(&attributes, &none);
  std::string name = "saccade", word = kServerWord;
  const std::array<char*, 3> words{name.data(), word.data(), nullptr};
  const int error =
      posix_spawnp(&server_, program.c_str(), &files, &attributes, words.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  ::close(ends[1]);
  if (error == 0) return;
  ::close(socket_);
  fail_to_serve("cannot be started", error);
}

ForkServer::~ForkServer() {
  ::close(socket_);
  while (::waitpid(server_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

ChildProcess ForkServer::start(const std::vector<std::string>& words,
                               const std::filesystem::path& log) {
  begin_log(log, words);
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) fail_to_serve("cannot be connected", errno);
  // The server need not be in the folder that this program is in by now.
  std::string text = std::filesystem::absolute(log).string() + '\0';
  for (const std::string& word : words) text += word + '\0';
  const bool is_sent = send_request(socket_, text, pipe[1]);
  ::close(pipe[1]);
  std::int32_t answer = -EPIPE;
  if (!is_sent || !receive_all(socket_, &answer, sizeof(answer))) answer = -EPIPE;
  if (answer > 0) return {answer, pipe[0]};
  ::close(pipe[0]);
  fail_to_serve("cannot be started", -answer);
}

}  // namespace saccade
