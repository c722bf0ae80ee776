#pragma once

#include <span>
#include <string_view>

#include "core/camera.h"
#include "core/image.h"
#include "core/imu_sample.h"
#include "core/io/events/event_file.h"
#include "core/io/ros/message_bytes.h"
#include "core/rigid3.h"

namespace saccade {

// Messages of the types of message_types.h, in the serialisation of `message`. Times are not before
// 1970.

/// dvs_msgs/EventArray; stamped with the time of the first event. `events`: not empty (contract).
void put_event_array(std::span<const Event> events, SensorSize sensor, MessageBytes& message);
/// event_camera_msgs/EventPacket in the encoding mono; likewise. The events last less than 4 s
/// and have rows up to 32767 (contract).
void put_event_packet(std::span<const Event> events, SensorSize sensor, std::uint64_t number,
                      MessageBytes& message);
/// sensor_msgs/Image: mono8, rgb8 or 32FC1.
void put_image(TimeNs t_ns, const ImageU8& codes, MessageBytes& message);
void put_image(TimeNs t_ns, const ImageRgb8& codes, MessageBytes& message);
void put_image(TimeNs t_ns, const ImageF& values, MessageBytes& message);
/// sensor_msgs/Imu without an orientation.
void put_imu(const ImuSample& sample, MessageBytes& message);
/// geometry_msgs/PoseStamped in the frame "world".
void put_pose(TimeNs t_ns, const Rigid3& world_from_camera, MessageBytes& message);
/// tf2_msgs/TFMessage: the frame "camera" in the frame "world".
void put_transform(TimeNs t_ns, const Rigid3& world_from_camera, MessageBytes& message);
/// sensor_msgs/CameraInfo, plumb_bob.
void put_camera_info(TimeNs t_ns, const PinholeCamera& camera, MessageBytes& message);
/// sensor_msgs/PointCloud2 of x, y, z (float32) in the frame "world".
void put_cloud(TimeNs t_ns, std::span<const Eigen::Vector3f> points_in_world,
               MessageBytes& message);

}  // namespace saccade
