#include "core/io/ros/rosbag2_file.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include "core/check.h"
#include "core/config/config.h"
#include "core/error.h"

namespace saccade {
namespace {

constexpr std::string_view kZstdMagic = "\x28\xB5\x2F\xFD";

/// What is read of metadata.yaml.
struct Rosbag2Metadata {
  std::vector<std::string> files;
  std::string compression_mode;
};

void describe(config::Fields& fields, Rosbag2Metadata& metadata) {
  fields.allow_unknown();
  fields.group(
      "rosbag2_bagfile_information",
      [&](config::Fields& keys) {
        keys.allow_unknown();
        keys.value("relative_file_paths", metadata.files, "files").required();
        keys.value("compression_mode", metadata.compression_mode, "of what");
      },
      "the recording");
}

/// An address of SQLite for a file that nobody changes, so that no journal is looked for or written
/// beside it.
std::string address_of(const std::filesystem::path& file) {
  std::string address = "file:";
  for (const char c : std::filesystem::absolute(file).string())
    if (c == '%' || c == '?' || c == '#')
      address += fmt::format("%{:02X}", static_cast<unsigned>(c));
    else
      address += c;
  return address + "?immutable=1";
}

}  // namespace

struct Rosbag2File::Database {
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

  std::unique_ptr<sqlite3, Close> file;
  Statement messages;
  std::int64_t last_id = 0;

  /// nullptr where the database lacks what it asks for.
  [[nodiscard]] Statement prepare(const char* sql) const {
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(file.get(), sql, -1, &statement, nullptr);
    return Statement(statement);
  }
};

Rosbag2File::Rosbag2File(const std::filesystem::path& file)
    : name_(file.string()), database_(std::make_unique<Database>()) {
  if (!std::filesystem::exists(file)) throw InputError(name_, "no such file");
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(address_of(file).c_str(), &opened,
                                   SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  database_->file.reset(opened);
  if (code != SQLITE_OK) fail_of_sqlite();
  read_topics();
  database_->messages =
      database_->prepare("SELECT id, topic_id, data FROM messages ORDER BY timestamp, id");
  if (!database_->messages) fail_of_sqlite();
}

Rosbag2File::~Rosbag2File() = default;

void Rosbag2File::fail_of_sqlite() const {
  throw InputError(
      name_ + (database_->last_id > 0 ? fmt::format(":after message {}", database_->last_id) : ""),
      fmt::format("is no rosbag2 that can be read, or is damaged (SQLite: {})",
                  sqlite3_errmsg(database_->file.get())));
}

void Rosbag2File::read_topics() {
  const auto text = [](sqlite3_stmt* row, int column) -> std::string {
    const unsigned char* value = sqlite3_column_text(row, column);
    return value == nullptr ? "" : reinterpret_cast<const char*>(value);
  };
  const Database::Statement topics =
      database_->prepare("SELECT id, name, type, serialization_format FROM topics");
  if (!topics) fail_of_sqlite();
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(topics.get())) == SQLITE_ROW) {
    MessageTopic topic{text(topics.get(), 1), text(topics.get(), 2), Serialisation::kOther};
    if (const std::size_t at = topic.type.find("/msg/"); at != std::string::npos)
      topic.type.erase(at, 4);
    if (text(topics.get(), 3) == "cdr") topic.serialisation = Serialisation::kCdr;
    topics_.try_emplace(sqlite3_column_int64(topics.get(), 0), std::move(topic));
  }
  if (code != SQLITE_DONE) fail_of_sqlite();
}

std::optional<Message> Rosbag2File::next() {
  // Another step behind the last row would begin anew.
  if (!database_->messages) return std::nullopt;
  sqlite3_stmt* row = database_->messages.get();
  const int code = sqlite3_step(row);
  if (code == SQLITE_DONE) {
    database_->messages.reset();
    return std::nullopt;
  }
  if (code != SQLITE_ROW) fail_of_sqlite();
  Message message;
  message.place = static_cast<std::uint64_t>(sqlite3_column_int64(row, 0));
  database_->last_id = sqlite3_column_int64(row, 0);
  static const MessageTopic nobody{"nobody", "", Serialisation::kOther};
  const auto topic = topics_.find(sqlite3_column_int64(row, 1));
  message.topic = topic == topics_.end() ? &nobody : &topic->second;
  if (topic == topics_.end()) fail(message, "it belongs to no topic; the file is damaged");
  const void* data = sqlite3_column_blob(row, 2);
  message.data = {static_cast<const std::byte*>(data),
                  static_cast<std::size_t>(sqlite3_column_bytes(row, 2))};
  const std::string_view bytes(static_cast<const char*>(data), message.data.size());
  try {
    if (bytes.starts_with(kZstdMagic)) message.data = zstd_.unpack(message.data);
  } catch (const CompressionError& error) {
    fail(message, error.problem);
  }
  return message;
}

std::vector<const MessageTopic*> Rosbag2File::topics() const {
  std::vector<const MessageTopic*> list;
  for (const auto& [id, topic] : topics_) list.push_back(&topic);
  return list;
}

std::uint64_t Rosbag2File::size() const { return std::filesystem::file_size(name_); }

InputError Rosbag2File::error_in(const Message& message, const std::string& problem) const {
  return {fmt::format("{}:message {}", name_, message.place), problem};
}

bool is_rosbag2_folder(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "metadata.yaml";
  if (!std::filesystem::is_regular_file(file)) return false;
  return config::load(file).root().find("rosbag2_bagfile_information") != nullptr;
}

Rosbag2Folder::Rosbag2Folder(const std::filesystem::path& folder) : name_(folder.string()) {
  const std::filesystem::path file = folder / "metadata.yaml";
  const auto metadata = config::read<Rosbag2Metadata>(config::load(file));
  if (metadata.compression_mode == "FILE")
    throw InputError(file.string(),
                     "names files that are compressed as a whole; unpack them first (zstd -d), and "
                     "name the .db3 or .mcap");
  for (const std::string& name : metadata.files) {
    // Older ones name the file below the folder's own name.
    const std::filesystem::path direct = folder / name;
    files_.push_back(
        open_message_file(std::filesystem::exists(direct) ? direct : folder / direct.filename()));
  }
  if (files_.empty()) throw InputError(file.string(), "names no files");
}

std::optional<Message> Rosbag2Folder::next() {
  while (current_ < files_.size()) {
    if (auto message = files_[current_]->next()) return message;
    ++current_;
  }
  return std::nullopt;
}

std::vector<const MessageTopic*> Rosbag2Folder::topics() const {
  std::vector<const MessageTopic*> list;
  for (const auto& file : files_)
    for (const MessageTopic* topic : file->topics()) list.push_back(topic);
  return list;
}

std::uint64_t Rosbag2Folder::size() const {
  std::uint64_t size = 0;
  for (const auto& file : files_) size += file->size();
  return size;
}

InputError Rosbag2Folder::error_in(const Message& message, const std::string& problem) const {
  SACCADE_CHECK(current_ < files_.size());
  return files_[current_]->error_in(message, problem);
}

}  // namespace saccade
