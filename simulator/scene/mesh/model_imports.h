#pragma once

#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/process/forked_call.h"

namespace saccade {

/// Imports many models by the rules of import_model(), several at a time and ahead of their use, in
/// processes that go on from one model to the next: what assimp and the archives need once is not
/// taken again for each.
class ModelImports {
 public:
  /// `files`: paths as FileLocation takes them, in the order of their use. Up to thread_count()
  /// processes, which with more than one begin at once.
  explicit ModelImports(std::vector<std::filesystem::path> files);
  ~ModelImports();
  ModelImports(const ModelImports&) = delete;
  ModelImports& operator=(const ModelImports&) = delete;

  /// Waits for the import of `file` and hands it over. nullopt when it is none of the files, or was
  /// taken before.
  [[nodiscard]] std::optional<ForkedResult> take(const std::filesystem::path& file);

 private:
  void work(ForkedWorker& worker);

  std::vector<std::filesystem::path> files_;
  std::size_t ahead_;
  std::vector<std::unique_ptr<ForkedWorker>> workers_;
  std::mutex mutex_;  ///< of what follows
  std::condition_variable changed_;
  std::size_t next_ = 0;  ///< first file whose import has not begun
  std::size_t end_;       ///< of those that may begin
  std::map<std::size_t, ForkedResult> results_;
  std::map<std::filesystem::path, std::size_t> waiting_;  ///< not taken yet
  bool is_stopped_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace saccade
