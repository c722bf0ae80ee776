#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace saccade {

/// Instances and classes are numbered from 1 on; 0 is the background, and what has no class.
constexpr std::size_t kMaxInstances = 65535;
constexpr std::size_t kMaxClasses = 255;

/// A mesh of the scene, or a node of its file, as masks and labels tell it apart from others.
struct SceneInstance {
  std::string name;           ///< for a reader
  std::string file;           ///< of the mesh
  std::uint32_t object = 0;   ///< index into the scene's mesh list
  std::uint8_t class_id = 0;  ///< 0: none
};

/// How the triangles of a mesh are labelled.
struct InstanceLabel {
  std::string name;
  std::string file;
  std::uint8_t class_id = 0;
  bool splits_nodes = false;  ///< every node of the file is an instance of its own
};

}  // namespace saccade
