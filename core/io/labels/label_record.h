#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/config/fields.h"

namespace saccade {

/// The contents of labels.yaml: what the numbers in masks, boxes.txt and labels.h5 stand for. 0 is
/// the background among instances, and what has no class among classes.
struct LabelRecord {
  struct Instance {
    std::int64_t id = 0;        ///< from 1 on, without gaps
    std::string name;           ///< of the mesh, or of the mesh and the node of its file
    std::int64_t class_id = 0;  ///< key `class`
    std::int64_t object = 0;    ///< index into the scene's mesh list, as in objects.txt
    std::string file;           ///< of the mesh
  };
  struct Class {
    std::int64_t id = 0;  ///< from 1 on, without gaps
    std::string name;
  };

  std::vector<Class> classes;
  std::vector<Instance> instances;
};

void describe(config::Fields& fields, LabelRecord::Instance& instance);
void describe(config::Fields& fields, LabelRecord::Class& item);
void describe(config::Fields& fields, LabelRecord& record);

/// InputError with file:line for unknown keys, numbers that are not in order, and classes that are
/// not listed.
[[nodiscard]] LabelRecord read_label_record(const std::filesystem::path& file);
void write_label_record(const std::filesystem::path& file, const LabelRecord& record);

}  // namespace saccade
