// Pictures, clouds, arrays, archives and journals.

#include "tests/fuzz/core/core_targets.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/io/files/block_journal.h"
#include "core/io/files/file_bytes.h"
#include "core/io/files/zip_archive.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/hdr_file.h"
#include "core/io/images/image_file.h"
#include "core/io/images/png_file.h"
#include "core/io/images/tga_file.h"
#include "core/io/images/webp_file.h"
#include "core/io/import/h5_arrays.h"
#include "core/io/ply_file.h"
#include "tests/support/h5_content.h"

namespace saccade::fuzz {
namespace {

namespace fs = std::filesystem;
using testing::H5Content;

constexpr int kWidth = 9;
constexpr int kHeight = 5;

ImageRgb8 some_picture() {
  ImageRgb8 image(kWidth, kHeight);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.pixels()[i] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(3 * i), 200};
  return image;
}

/// A baseline JPEG of 8 x 8 grey pixels: one block, all of whose coefficients are 0.
std::string small_jpeg() {
  std::string bytes = "\xff\xd8\xff\xdb";
  bytes += std::string("\x00\x43\x00", 3) + std::string(64, '\x10');
  bytes += std::string("\xff\xc0\x00\x0b\x08\x00\x08\x00\x08\x01\x01\x11\x00", 13);
  for (const char kind : {'\x00', '\x10'})
    bytes += std::string("\xff\xc4\x00\x14", 4) + kind + std::string(1, '\x01') +
             std::string(15, '\0') + std::string(1, '\0');
  bytes += std::string("\xff\xda\x00\x08\x01\x01\x00\x00\x3f\x00", 10) + "\x3f\xff\xd9";
  return bytes;
}

void write_pictures(const fs::path& folder) {
  const ImageRgb8 image = some_picture();
  write_bytes(folder / "a.png", encode_png(image));
  write_bytes(folder / "grey.png", encode_png(ImageU16(kWidth, kHeight, 7)));
  write_bytes(folder / "a.webp", encode_webp(image));
  write_bytes(folder / "a.jpg", small_jpeg());
  std::string tga(18, '\0');
  tga[2] = 2;
  tga[12] = tga[14] = 2;
  tga[16] = 24;
  write_bytes(folder / "a.tga", tga + std::string(12, '\x7f'));
  std::string bmp("BM\x46\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x02\0\0\0\x02\0\0\0\x01\0\x18\0", 30);
  write_bytes(folder / "a.bmp", bmp + std::string(24, '\0') + std::string(16, '\x55'));
  std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n";
  write_bytes(folder / "a.hdr", hdr + std::string(16, '\x80'));
}

void decode_pictures(const fs::path& folder, const std::string& file) {
  const std::vector<std::byte> bytes = read_file_bytes(folder / file);
  if (file == "a.tga") return static_cast<void>(decode_tga(bytes, file));
  if (file == "a.hdr") return static_cast<void>(decode_hdr(bytes, file));
  if (file == "grey.png") return static_cast<void>(read_image_u16(folder / file));
  static_cast<void>(decode_image_rgba(bytes, file));
  static_cast<void>(read_image_grey(folder / file));
}

void write_exrs(const fs::path& folder) {
  const ImageF plane(kWidth, kHeight, 0.5F);
  write_exr(folder / "depth.exr", plane, "Z");
  write_exr(folder / "rgb.exr", ImageRgbF(kWidth, kHeight));
  write_exr_flow(folder / "flow.exr", {plane, plane});
}

void decode_exrs(const fs::path& folder, const std::string& file) {
  if (file == "flow.exr") return static_cast<void>(read_exr_flow(folder / file));
  if (file == "rgb.exr") return static_cast<void>(read_exr_rgb(folder / file));
  static_cast<void>(read_exr(folder / file));
}

void write_clouds(const fs::path& folder) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {4, 5, 6}};
  cloud.normals = {{0, 0, 1}, {1, 0, 0}};
  cloud.colours = {{255, 0, 7}, {1, 2, 3}};
  cloud.scalars = {{"sigma", {0.5F, 0.25F}}};
  write_ply(folder / "binary.ply", cloud);
  write_bytes(
      folder / "ascii.ply",
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty "
      "float z\nproperty uchar red\nelement face 1\nproperty list uchar int "
      "vertex_index\nend_header\n1 2 3 4\n5 6 7 8\n3 0 1 0\n");
}

void decode_clouds(const fs::path& folder, const std::string& file) {
  static_cast<void>(read_ply(folder / file));
}

void write_arrays(const fs::path& folder) {
  std::vector<double> matrices;
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 16; ++k) matrices.push_back(k % 5 == 0 ? 1 : 0);
  H5Content(folder / "a.h5")
      .array<double>("/poses", {2, 4, 4}, matrices)
      .column("/times", std::vector<double>{0.5, 0.75})
      .array<float>("/depth", {2, kHeight, kWidth}, std::vector<float>(2 * kWidth * kHeight, 1))
      .array<std::uint8_t>("/grey", {2, kHeight, kWidth},
                           std::vector<std::uint8_t>(2 * kWidth * kHeight, 1))
      .text("/name", "a text");
}

void decode_arrays(const fs::path& folder, const std::string& name) {
  const H5File file(folder / name);
  static_cast<void>(file.text("/name"));
  static_cast<void>(read_h5_poses(file, "/poses", "/times", 1, true));
  static_cast<void>(read_h5_times(file, "/times", 1e-6));
  static_cast<void>(read_h5_depth(file, "/depth", 1, kWidth, kHeight));
  static_cast<void>(read_h5_grey(file, "/grey", 1, kWidth, kHeight));
  static_cast<void>(file.floats_at("/depth", 1));
}

void write_archives(const fs::path& folder) {
  write_bytes(folder / "a.txt", "some text");
  write_zip(folder / "a.zip", {{"a.txt", folder / "a.txt"}, {"b/c.txt", folder / "a.txt"}});
}

void decode_archives(const fs::path& folder, const std::string& file) {
  ZipArchive archive(folder / file);
  std::array<std::byte, 4096> block{};
  for (const std::string& name : archive.members()) {
    if (!archive.contains(name) || name.ends_with('/')) continue;
    ZipMember member(archive, name);
    // What asks for whole members bounds them itself.
    for (int i = 0; i < 64 && member.read(block) == block.size(); ++i) {
    }
  }
}

void write_journals(const fs::path& folder) {
  BlockJournal journal(folder / "a.journal", 0);
  const std::string text = "a block of the journal";
  for (int i = 0; i < 3; ++i) {
    journal.append(std::as_bytes(std::span(text)));
    journal.flush();
  }
}

void decode_journals(const fs::path& folder, const std::string& file) {
  const BlockJournal journal(folder / file, fs::file_size(folder / file));
  journal.read([](std::span<const std::byte> block) {
    static_cast<void>(std::ranges::count(block, std::byte{0}));
  });
}

}  // namespace

std::vector<Target> binary_targets() {
  return {
      {"pictures",
       {"a.png", "grey.png", "a.webp", "a.jpg", "a.tga", "a.bmp", "a.hdr"},
       decode_pictures,
       write_pictures,
       {"IHDR", "IDAT", "PLTE", "tRNS", "IEND", "VP8L", "VP8 ", "VP8X", "RIFF", "WEBP", "DDS ",
        "II*", "MM", "-Y 2 +X 2\n"}},
      {"exr",
       {"depth.exr", "rgb.exr", "flow.exr"},
       decode_exrs,
       write_exrs,
       {"channels", "chlist", "dataWindow", "box2i", "compression", "tiles", "tiledesc",
        "chunkCount"}},
      {"ply",
       {"binary.ply", "ascii.ply"},
       decode_clouds,
       write_clouds,
       {"element vertex 4294967296\n", "property double x\n", "property list uchar int i\n",
        "format ascii 1.0\n", "end_header\n", "nan", "-1"}},
      {"h5-arrays",
       {"a.h5"},
       decode_arrays,
       write_arrays,
       {"OHDR", "TREE", "HEAP", "SNOD", "GCOL"}},
      {"zip",
       {"a.zip"},
       decode_archives,
       write_archives,
       {"PK\x03\x04", "PK\x01\x02", "PK\x05\x06"}},
      {"journal", {"a.journal"}, decode_journals, write_journals, {}},
  };
}

}  // namespace saccade::fuzz
