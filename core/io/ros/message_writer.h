#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "core/event.h"
#include "core/io/ros/message_file.h"

namespace saccade {

/// Writes a recording of ROS, message by message. Nothing stands under the final name before
/// close(); without it everything is discarded. The same messages give the same bytes.
class MessageFileWriter {
 public:
  virtual ~MessageFileWriter() = default;
  /// `type` as ROS 1 names it, one of message_types.h. The number of the topic.
  virtual unsigned add_topic(std::string_view name, std::string_view type) = 0;
  /// `bytes`: a message of the topic's type in serialisation().
  virtual void write(unsigned topic, TimeNs t_ns, std::span<const std::byte> bytes) = 0;
  virtual void close() = 0;
  [[nodiscard]] virtual Serialisation serialisation() const = 0;
};

/// A bag of ROS 1, its chunks not compressed, with its index.
[[nodiscard]] std::unique_ptr<MessageFileWriter> make_bag_writer(const std::filesystem::path& file);
/// An MCAP with messages of ROS 2, its chunks compressed by LZ4, with index and summary.
[[nodiscard]] std::unique_ptr<MessageFileWriter> make_mcap_writer(
    const std::filesystem::path& file);

/// Whether files of this ending are recordings of ROS that are written: .bag, .mcap.
[[nodiscard]] bool is_written_recording(const std::filesystem::path& file);
/// The writer for the ending, one of them (contract).
[[nodiscard]] std::unique_ptr<MessageFileWriter> make_message_writer(
    const std::filesystem::path& file);

}  // namespace saccade
