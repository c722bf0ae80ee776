#include "apps/view_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/random.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/process/child_process.h"
#include "eval/view/view_query.h"

namespace saccade {
namespace {

constexpr const char* kHost = "127.0.0.1";
// A connection that a browser keeps open has a thread of its own; it keeps six for a page.
constexpr std::size_t kThreads = 24;
constexpr int kIdle_s = 2;
constexpr std::size_t kLongestBody = 4096;  // no request needs one

/// 128 bits of the system's random numbers, in hexadecimal digits.
std::string random_token() {
  std::array<std::uint8_t, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("the system gives no random numbers");
  std::string token;
  for (const std::uint8_t byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

/// The library's default lets a second program share the port.
void set_socket_options(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

const httplib::Headers kHeaders{
    {"Cache-Control", "no-store"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Content-Security-Policy",
     "default-src 'self' data: blob: 'unsafe-inline'; frame-ancestors 'none'; base-uri 'none'"}};

/// Handed out piecewise: as a whole text the library would compress it, which takes longer than
/// sending it within a machine.
void send(ViewAnswer&& answer, httplib::Response& response) {
  response.status = answer.status;
  const auto body = std::make_shared<const std::string>(std::move(answer.body));
  if (body->empty()) return;
  response.set_content_provider(
      body->size(), answer.type,
      [body](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(body->data() + offset, length);
      });
}

}  // namespace

struct ViewServer::State {
  explicit State(ViewSession& answering) : session(answering) {}

  ViewAnswer answer(const httplib::Request& request) {
    try {
      const std::string_view rest = behind_token(request.target, token);
      if (request.method != "GET" && request.method != "HEAD")
        throw BadRequest(405, "only GET is answered");
      if (!request.ranges.empty()) throw BadRequest(416, "answers are given as a whole");
      return session.answer(rest);
    } catch (const BadRequest& refusal) {
      return {refusal.status(), "text/plain; charset=utf-8", refusal.what()};
    } catch (const std::exception& error) {
      return {500, "text/plain; charset=utf-8", error.what()};
    }
  }

  ViewSession& session;
  httplib::Server server;
  std::string token = random_token();
  int port = 0;
};

ViewServer::ViewServer(ViewSession& session, int port) : state_(std::make_unique<State>(session)) {
  httplib::Server& server = state_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_keep_alive_timeout(kIdle_s);
  server.set_socket_options(set_socket_options);
  server.set_default_headers(kHeaders);
  server.set_payload_max_length(kLongestBody);
  server.set_tcp_nodelay(true);
  server.set_pre_routing_handler(
      [this](const httplib::Request& request, httplib::Response& response) {
        send(state_->answer(request), response);
        return httplib::Server::HandlerResponse::Handled;
      });
  if (port == 0) {
    state_->port = server.bind_to_any_port(kHost);
    if (state_->port <= 0) throw std::runtime_error("no port can be opened on 127.0.0.1");
    return;
  }
  if (!server.bind_to_port(kHost, port))
    throw InputError("--port", fmt::format("{} is taken or not allowed; choose another one, or "
                                           "leave it out for a free one",
                                           port));
  state_->port = port;
}

ViewServer::~ViewServer() = default;

std::string ViewServer::url() const {
  return fmt::format("http://{}:{}/{}/", kHost, state_->port, state_->token);
}

void ViewServer::run(const std::function<void()>& ready) {
  constexpr auto kPoll = std::chrono::milliseconds(50);  ///< a person does not notice it
  const InterruptGuard interrupted;
  std::thread serving([this] { state_->server.listen_after_bind(); });
  ready();
  while (!interrupted.requested()) std::this_thread::sleep_for(kPoll);
  state_->server.stop();
  serving.join();
}

}  // namespace saccade
