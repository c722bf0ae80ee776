#include "simulator/scene/mesh/model.h"

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace saccade {
namespace {

template <class T>
constexpr bool kIsPlain = std::is_arithmetic_v<T>;
template <class T, std::size_t n>
constexpr bool kIsPlain<std::array<T, n>> = std::is_arithmetic_v<T>;
template <>
constexpr bool kIsPlain<WrapModes> = std::is_trivially_copyable_v<WrapModes>;
template <>
constexpr bool kIsPlain<KeyInterpolation> = true;

class ModelWriter {
 public:
  template <class T>
  void operator()(const T& value) {
    if constexpr (kIsPlain<T>) {
      raw(&value, sizeof(T));
    } else {
      visit(*this, value);
    }
  }
  void operator()(const std::string& text) {
    size(text.size());
    raw(text.data(), text.size());
  }
  template <class T>
  void operator()(const std::vector<T>& items) {
    size(items.size());
    if constexpr (kIsPlain<T>) {
      raw(items.data(), items.size() * sizeof(T));
    } else {
      for (const T& item : items) (*this)(item);
    }
  }
  template <class T>
  void operator()(const std::optional<T>& value) {
    (*this)(value.has_value());
    if (value) (*this)(*value);
  }

  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  void size(std::uint64_t count) { raw(&count, sizeof(count)); }
  void raw(const void* data, std::size_t count) {
    if (count > 0) bytes_.append(static_cast<const char*>(data), count);
  }

  std::string bytes_;
};

class ModelReader {
 public:
  explicit ModelReader(const std::string& bytes) : bytes_(bytes) {}

  template <class T>
  void operator()(T& value) {
    if constexpr (kIsPlain<T>) {
      raw(&value, sizeof(T));
    } else {
      visit(*this, value);
    }
  }
  void operator()(std::string& text) {
    text.resize(size(1));
    raw(text.data(), text.size());
  }
  template <class T>
  void operator()(std::vector<T>& items) {
    items.resize(size(kIsPlain<T> ? sizeof(T) : 1));
    if constexpr (kIsPlain<T>) {
      raw(items.data(), items.size() * sizeof(T));
    } else {
      for (T& item : items) (*this)(item);
    }
  }
  template <class T>
  void operator()(std::optional<T>& value) {
    std::uint8_t is_there = 0;
    raw(&is_there, sizeof(is_there));
    if (is_there != 0) (*this)(value.emplace());
  }

  void expect_end() const {
    if (position_ != bytes_.size()) throw std::runtime_error("more bytes than a model has");
  }

 private:
  [[nodiscard]] std::size_t size(std::size_t bytes_each) {
    std::uint64_t count = 0;
    raw(&count, sizeof(count));
    if (count > (bytes_.size() - position_) / bytes_each)
      throw std::runtime_error("fewer bytes than a model has");
    return count;
  }
  void raw(void* target, std::size_t count) {
    if (count > bytes_.size() - position_) throw std::runtime_error("fewer bytes than a model has");
    if (count > 0) std::memcpy(target, bytes_.data() + position_, count);
    position_ += count;
  }

  const std::string& bytes_;
  std::size_t position_ = 0;
};

template <class T, class U>
constexpr bool kIsA = std::is_same_v<std::remove_const_t<T>, U>;

/// Every member in its order, for writer and reader alike.
template <class Archive, class T>
void visit(Archive& archive, T& value) {
  if constexpr (kIsA<T, ModelTexture>) {
    archive(value.name), archive(value.wrap), archive(value.uv_channel), archive(value.embedded);
  } else if constexpr (kIsA<T, ModelMaterial>) {
    archive(value.name), archive(value.colour), archive(value.opacity), archive(value.is_linear);
    archive(value.ignores_alpha), archive(value.colour_texture), archive(value.opacity_texture);
    archive(value.normal_texture);
    archive(value.ignored);
  } else if constexpr (kIsA<T, ModelPart>) {
    archive(value.material), archive(value.vertices), archive(value.normals), archive(value.uvs);
    archive(value.colours), archive(value.tangents), archive(value.triangles);
    archive(value.bones);
  } else if constexpr (kIsA<T, ModelBone>) {
    archive(value.name), archive(value.node), archive(value.bone_from_part);
    archive(value.vertices), archive(value.weights);
  } else if constexpr (kIsA<T, ModelInstance>) {
    archive(value.part), archive(value.node), archive(value.tree_node);
    archive(value.file_from_part);
  } else if constexpr (kIsA<T, ModelPicture>) {
    archive(value.hint), archive(value.width), archive(value.height), archive(value.bytes);
  } else if constexpr (kIsA<T, ModelCamera>) {
    archive(value.name), archive(value.node), archive(value.position), archive(value.forward);
    archive(value.up), archive(value.horizontal_fov_rad), archive(value.vertical_fov_rad);
  } else if constexpr (kIsA<T, ModelNode>) {
    archive(value.name), archive(value.parent), archive(value.parent_from_node);
  } else if constexpr (kIsA<T, ModelTrack>) {
    archive(value.interpolation), archive(value.times_s), archive(value.values);
  } else if constexpr (kIsA<T, ModelChannel>) {
    archive(value.node), archive(value.translation), archive(value.rotation);
    archive(value.scale);
  } else if constexpr (kIsA<T, ModelAnimation>) {
    archive(value.name), archive(value.duration_s), archive(value.channels);
  } else {
    static_assert(kIsA<T, Model>);
    archive(value.materials), archive(value.parts), archive(value.instances);
    archive(value.pictures), archive(value.cameras), archive(value.lights);
    archive(value.tree), archive(value.animations), archive(value.opened), archive(value.nodes);
  }
}

}  // namespace

std::string to_bytes(const Model& model) {
  ModelWriter writer;
  writer(model);
  return writer.take();
}

Model model_from_bytes(const std::string& bytes) {
  ModelReader reader(bytes);
  Model model;
  reader(model);
  reader.expect_end();
  return model;
}

}  // namespace saccade
