#include "simulator/scene/mesh/model_imports.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/process/parallel.h"
#include "simulator/scene/mesh/ac3d_file.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/mesh/gltf_file.h"
#include "simulator/scene/mesh/model_import.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Models that may wait for their use, per process: enough that none idles, few enough for memory.
constexpr std::size_t kAheadOfUse = 2;

/// What one process has open. An archive that two processes share would be read by both at one
/// position, so that it is opened there.
using OpenSources = std::map<fs::path, FileSource>;

std::string import_from(OpenSources& sources, const std::string& path) {
  const FileLocation location = FileLocation::parse(path);
  const FileSource& source =
      sources.try_emplace(location.archive, location.archive, FileSource::Reporting::kNone)
          .first->second;
  const std::optional<GltfFile> gltf = GltfFile::open(source, location.file, location.text());
  return import_in_child(source, location.file,
                         gltf ? gltf->for_assimp() : ac3d_for_assimp(source, location.file));
}

/// Whatever happens is a result: an exception would end the program, in a thread of its own.
ForkedResult result_of(ForkedWorker& worker, const std::string& file) {
  try {
    return worker.call(file);
  } catch (const std::exception& error) {
    return {{}, error.what(), true};
  }
}

}  // namespace

ModelImports::ModelImports(std::vector<fs::path> files) : files_(std::move(files)) {
  const std::size_t count =
      std::min(files_.size(), static_cast<std::size_t>(std::max(thread_count(), 1)));
  ahead_ = thread_count() > 1 ? kAheadOfUse * count : 0;
  end_ = std::min(ahead_, files_.size());
  for (std::size_t i = 0; i < files_.size(); ++i) waiting_.emplace(files_[i], i);
  for (std::size_t i = 0; i < count; ++i)
    workers_.push_back(std::make_unique<ForkedWorker>(
        [sources = std::make_shared<OpenSources>()](const std::string& path) {
          return import_from(*sources, path);
        }));
  for (const auto& worker : workers_) threads_.emplace_back([this, &worker] { work(*worker); });
}

ModelImports::~ModelImports() {
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
  }
  changed_.notify_all();
  for (const auto& worker : workers_) worker->stop();
  for (std::thread& thread : threads_) thread.join();
}

void ModelImports::work(ForkedWorker& worker) {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_stopped_ || next_ < end_; });
    if (is_stopped_) return;
    const std::size_t index = next_++;
    lock.unlock();
    ForkedResult result = result_of(worker, files_[index].string());
    lock.lock();
    results_.emplace(index, std::move(result));
    changed_.notify_all();
  }
}

std::optional<ForkedResult> ModelImports::take(const fs::path& file) {
  std::unique_lock lock(mutex_);
  const auto known = waiting_.extract(file);
  if (known.empty()) return std::nullopt;
  const std::size_t index = known.mapped();
  end_ = std::max(end_, std::min(index + 1 + ahead_, files_.size()));
  changed_.notify_all();
  changed_.wait(lock, [&] { return results_.contains(index); });
  return std::move(results_.extract(index).mapped());
}

}  // namespace saccade
