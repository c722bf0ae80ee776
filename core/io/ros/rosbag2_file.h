#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/files/compression.h"
#include "core/io/ros/message_file.h"

namespace saccade {

constexpr std::string_view kSqliteMagic = "SQLite format 3";

/// The messages of one SQLite file of rosbag2, in order of the time at which they were recorded;
/// each may be compressed by Zstandard. InputError with "FILE:message NUMBER".
class Rosbag2File final : public MessageFile {
 public:
  explicit Rosbag2File(const std::filesystem::path& file);
  ~Rosbag2File() override;

  [[nodiscard]] std::optional<Message> next() override;
  [[nodiscard]] std::vector<const MessageTopic*> topics() const override;
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::uint64_t size() const override;
  [[nodiscard]] InputError error_in(const Message& message,
                                    const std::string& problem) const override;

 private:
  struct Database;
  [[noreturn]] void fail_of_sqlite() const;
  void read_topics();

  std::string name_;
  std::unique_ptr<Database> database_;
  std::map<std::int64_t, MessageTopic> topics_;
  Unpacker zstd_{Unpacker::Method::kZstd};
};

/// Whether a folder holds a metadata.yaml of rosbag2.
[[nodiscard]] bool is_rosbag2_folder(const std::filesystem::path& folder);

/// The files that the metadata.yaml of a folder names, SQLite or MCAP, one after the other.
class Rosbag2Folder final : public MessageFile {
 public:
  explicit Rosbag2Folder(const std::filesystem::path& folder);

  [[nodiscard]] std::optional<Message> next() override;
  [[nodiscard]] std::vector<const MessageTopic*> topics() const override;
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::uint64_t size() const override;
  [[nodiscard]] InputError error_in(const Message& message,
                                    const std::string& problem) const override;

 private:
  std::string name_;
  std::vector<std::unique_ptr<MessageFile>> files_;
  std::size_t current_ = 0;
};

}  // namespace saccade
