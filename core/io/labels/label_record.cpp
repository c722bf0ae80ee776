#include "core/io/labels/label_record.h"

#include "core/config/config.h"
#include "core/io/files/atomic_file.h"

namespace saccade {
namespace {

template <class Item>
bool are_numbered(const std::vector<Item>& items) {
  std::int64_t next = 1;
  for (const Item& item : items)
    if (item.id != next++) return false;
  return true;
}

bool have_listed_classes(const LabelRecord& record) {
  for (const LabelRecord::Instance& instance : record.instances)
    if (instance.class_id > static_cast<std::int64_t>(record.classes.size())) return false;
  return true;
}

}  // namespace

void describe(config::Fields& fields, LabelRecord::Instance& instance) {
  fields.value("id", instance.id, "in masks, boxes.txt and labels.h5").range(1, 65535).required();
  fields.value("name", instance.name, "of the mesh, or of the mesh and the node of its file");
  fields.value("class", instance.class_id, "number of its class, 0 = none").range(0, 255);
  fields.value("object", instance.object, "index into the scene's mesh list").at_least(0);
  fields.value("file", instance.file, "of the mesh");
}

void describe(config::Fields& fields, LabelRecord::Class& item) {
  fields.value("id", item.id, "in masks, boxes.txt and labels.h5").range(1, 255).required();
  fields.value("name", item.name, "of the class").required();
}

void describe(config::Fields& fields, LabelRecord& record) {
  fields.list("classes", record.classes, "of instances");
  fields.list("instances", record.instances, "of the scene");
  fields.expect(are_numbered(record.classes), "classes", "must have the ids 1, 2, 3 ...");
  fields.expect(are_numbered(record.instances), "instances", "must have the ids 1, 2, 3 ...");
  fields.expect(have_listed_classes(record), "instances", "have a class that is not listed");
}

LabelRecord read_label_record(const std::filesystem::path& file) {
  return config::read<LabelRecord>(config::load(file));
}

void write_label_record(const std::filesystem::path& file, const LabelRecord& record) {
  write_atomically(file, config::print(record));
}

}  // namespace saccade
