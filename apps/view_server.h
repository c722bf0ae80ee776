#pragma once

#include <functional>
#include <string>

#include "eval/view/view_session.h"

namespace saccade {

/// Serves a page on this machine alone (127.0.0.1) under an address that nobody guesses: requests
/// whose path does not begin with its random token are answered by 403. GET and HEAD alone.
class ViewServer {
 public:
  /// Takes the port; 0: a free one. InputError naming --port where it is taken.
  ViewServer(ViewSession& session, int port);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  /// "http://127.0.0.1:PORT/TOKEN/".
  [[nodiscard]] std::string url() const;
  /// Answers requests until SIGINT or SIGTERM; once. Calls `ready` when it does.
  void run(const std::function<void()>& ready);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade
