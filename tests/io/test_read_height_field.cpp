#include "taut/io/read_surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "io/read_text.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using test::from_hex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

HeightField read_as(std::string_view name, std::string_view bytes) {
  const test::TempFolder folder;
  return read_height_field(folder.write(name, bytes));
}

std::string error_of(std::string_view name, std::string_view bytes) {
  try {
    (void)read_as(name, bytes);
  } catch (const IoError& error) {
    return error.what();
  }
  return {};
}

/// 4 x 5 pixels of 16 bits with a gamma, which must not touch the values.
constexpr std::string_view kGrey =
    "89504e470d0a1a0a0000000d49484452000000040000000510000000001756ce440000000467414d410000b18f0bfc6105000000"
    "3249444154789c63606060606460626006928c8c8c4cffff3330b03370307032703130bf60bfc0bd837f0103032b031b48140068"
    "69057b601a986f0000000049454e44ae426082";
constexpr std::string_view kColours =
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c49444154789c636064620600000e00"
    "07d76fe4780000000049454e44ae426082";

TEST(ReadHeightField, PicturesStandAsTheyAreSeen) {
  const HeightField png = read_as("a.png", from_hex(kGrey));
  EXPECT_EQ(png.columns, 4);
  ASSERT_EQ(png.rows, 5);
  // The lowest row comes first.
  EXPECT_THAT(png.heights,
              ElementsAre(5, 6, 7, 8, 1000, 2000, 3000, 4000, 7, 8, 9, 10, 256, 257, 258, 65535, 0, 1, 2, 3));

  const HeightField plain = read_as("a.pgm", "P2 # remark\n3 2\n# another\n99\n1 2 3\n4 5 6\n");
  EXPECT_THAT(plain.heights, ElementsAre(4, 5, 6, 1, 2, 3));
  EXPECT_EQ(plain.columns, 3);
  const HeightField raw = read_as("a.PGM", std::string("P5 3 2 255\n\x01\x02\x03\xFF\x05\x06"));
  EXPECT_THAT(raw.heights, ElementsAre(255, 5, 6, 1, 2, 3));
  using namespace std::string_literals;
  const HeightField wide = read_as("a.pgm", "P5\n2 1\n65535\n\x01\x00\x00\x07"s);
  EXPECT_THAT(wide.heights, ElementsAre(256, 7));
}

TEST(ReadHeightField, ArraysStandAsTheyAreIndexed) {
  std::string bytes = "\x93NUMPY";
  const std::string dictionary = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }\n";
  bytes += std::string("\x01\x00", 2) + test::raw(static_cast<std::uint16_t>(dictionary.size())) + dictionary;
  for (int i = 0; i < 6; ++i) bytes += test::raw(static_cast<double>(i));
  const HeightField field = read_as("a.npy", bytes);
  EXPECT_EQ(field.columns, 3);
  EXPECT_EQ(field.rows, 2);
  EXPECT_THAT(field.heights, ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(ReadHeightField, MistakesAreNamed) {
  EXPECT_THAT(error_of("a.png", from_hex(kColours)), HasSubstr("colours"));
  const std::string whole = from_hex(kGrey);
  for (std::size_t cut = 8; cut < whole.size() - 16; cut += 5) {
    EXPECT_THAT(error_of("a.png", whole.substr(0, cut)), HasSubstr("no whole PNG")) << cut;
  }
  EXPECT_THAT(error_of("a.png", "nothing of the kind"), HasSubstr("PNG"));
  EXPECT_THAT(error_of("a.pgm", "P6 1 1 255\n123"), HasSubstr("no grey PGM"));
  EXPECT_THAT(error_of("a.pgm", "P5 30 20 255\n123"), HasSubstr("cut short"));
  EXPECT_THAT(error_of("a.pgm", "P2 2 2 255\n1 2 3 "), HasSubstr("pixels"));
  EXPECT_THAT(error_of("a.pgm", "P5 2 2 70000\n1234"), HasSubstr("largest value"));
  EXPECT_THAT(error_of("a.pgm", "P5 0 2 7\n1234"), HasSubstr("0 x 2"));
  EXPECT_THAT(error_of("a.pgm", "P2 2 2 7\n1 2 8 4"), HasSubstr("pixel 2 is 8, but the header says"));
  EXPECT_THAT(error_of("a.tif", "II"), HasSubstr(".pgm, .png and .npy"));
}

}  // namespace
}  // namespace taut
