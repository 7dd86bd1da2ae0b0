#include "../support/files.h"
#include "scan_files.h"

#include "film_io.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <csignal>
#include <limits>

#include <sys/resource.h>
#include <unistd.h>

using namespace brume;
using scan_files::folder;
using scan_files::load;
using scan_files::save;

namespace
{

Film film_of_all_values()
{
  Film film(3, 2);
  float v = 0.1f;
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      film.radiance[c][i] = (v *= 1.7f);
      film.transmittance[c][i] = 1 / (1 + v);
      film.depth[i] = v + 3;
      film.error[i] = v / 1000;
    }
  }
  film.radiance[0][1] = std::numeric_limits<float>::quiet_NaN();
  film.radiance[1][2] = std::numeric_limits<float>::infinity();
  film.radiance[2][3] = -0.f;
  film.radiance[2][4] = std::numeric_limits<float>::denorm_min();
  film.depth[5] = std::numeric_limits<float>::infinity();
  return film;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}

TEST(FilmIo, ExrRoundTripIsBitExact)
{
  const Film film = film_of_all_values();
  const std::string path = folder() + "a.exr";
  write_exr(film, path, { { "brume:mapper", "none" } });
  const Film back = read_exr(path);
  ASSERT_EQ(back.width, 3);
  ASSERT_EQ(back.height, 2);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_TRUE(same_bits(film.radiance[c], back.radiance[c]));
    EXPECT_TRUE(same_bits(film.transmittance[c], back.transmittance[c]));
  }
  EXPECT_TRUE(same_bits(film.depth, back.depth));
  EXPECT_TRUE(same_bits(film.error, back.error));
}

TEST(FilmIo, ExrHoldsTheChannelsOfTheContract)
{
  const Film film = film_of_all_values();
  const std::string path = folder() + "a.exr";
  write_exr(film, path, { { "brume:mapper", "raymarch" } });
  // An independent reader, without the class under test.
  const auto input = OIIO::ImageInput::open(path);
  ASSERT_TRUE(input);
  const OIIO::ImageSpec spec = input->spec();
  EXPECT_EQ(spec.nchannels, 9);
  EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
  for (const char* name :
    { "R", "G", "B", "A", "transmittance.R", "transmittance.G", "transmittance.B", "Z",
      "error" })
  {
    EXPECT_GE(spec.channelindex(name), 0) << name;
  }
  EXPECT_EQ(spec.get_string_attribute("Software").substr(0, 6), "Brume ");
  EXPECT_EQ(spec.get_string_attribute("brume:mapper"), "raymarch");
  std::vector<float> pixels(6 * 9);
  ASSERT_TRUE(input->read_image(0, 0, 0, 9, OIIO::TypeDesc::FLOAT, pixels.data()));
  // The file's first row is the picture's top one: pixel (0, 1) of the film.
  const auto first = [&](const char* name) { return pixels[spec.channelindex(name)]; };
  EXPECT_EQ(first("R"), film.radiance[0][3]);
  EXPECT_EQ(first("G"), film.radiance[1][3]);
  EXPECT_EQ(first("transmittance.B"), film.transmittance[2][3]);
  EXPECT_EQ(first("error"), film.error[3]);
  EXPECT_EQ(first("Z"), film.depth[3]);
  EXPECT_FLOAT_EQ(first("A"), 1 - (film.transmittance[0][3] + film.transmittance[1][3] +
                                    film.transmittance[2][3]) / 3);
}

TEST(FilmIo, DisplayRoundsToTheNearestByte)
{
  const Display plain;
  for (int i = 0; i < 256; ++i)
  {
    EXPECT_EQ(display_byte(static_cast<float>((i + 0.499) / 255), plain), i);
    EXPECT_EQ(display_byte(static_cast<float>((i - 0.499) / 255), plain), i);
  }
  EXPECT_EQ(display_byte(7, plain), 255);
  EXPECT_EQ(display_byte(-7, plain), 0);
  EXPECT_EQ(display_byte(NAN, plain), 0);
  EXPECT_EQ(display_byte(INFINITY, plain), 255);
  EXPECT_EQ(display_byte(-INFINITY, plain), 0);
  EXPECT_EQ(display_byte(0.1f, { 2, Display::Curve::None }), 102);
  const Display srgb{ 0, Display::Curve::SRGB };
  EXPECT_EQ(display_byte(0, srgb), 0);
  EXPECT_EQ(display_byte(1, srgb), 255);
  // IEC 61966-2-1: the byte 128 is a linear 0.21586; below 0.0031308 the curve is a line.
  EXPECT_EQ(display_byte(0.21586f, srgb), 128);
  EXPECT_EQ(display_byte(0.001f, srgb), 3);
}

TEST(FilmIo, PngIsTopDownAndByteForByte)
{
  const std::string here = folder();
  // Bottom row black, red; top row green, half blue.
  write_png({ 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5f }, 2, 2, here + "a.png");
  const auto input = OIIO::ImageInput::open(here + "a.png");
  ASSERT_TRUE(input);
  ASSERT_EQ(input->spec().nchannels, 3);
  std::vector<unsigned char> pixels(12);
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()));
  EXPECT_EQ(pixels, (std::vector<unsigned char>{ 0, 255, 0, 0, 0, 128, 0, 0, 0, 255, 0, 0 }));

  Film film(1, 1);
  film.radiance[0][0] = 0.25f;
  film.transmittance[0][0] = 0.5f;
  const double background[3] = { 0.5, 0.2, 1 };
  write_png(film, background, here + "b.PNG");
  const auto second = OIIO::ImageInput::open(here + "b.PNG");
  ASSERT_TRUE(second);
  ASSERT_TRUE(second->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()));
  EXPECT_EQ(pixels[0], 128);
  EXPECT_EQ(pixels[1], 51);
  EXPECT_EQ(pixels[2], 255);
}

TEST(FilmIo, HdrIsTopDownAndWithinItsQuantisation)
{
  const std::string path = folder() + "a.hdr";
  const std::vector<float> rgb{ 0, 0, 0, 1000, 3, 0.5f, -1, NAN, 0.25f, INFINITY, 0, 1e-30f };
  write_hdr(rgb, 2, 2, path);
  const auto input = OIIO::ImageInput::open(path);
  ASSERT_TRUE(input);
  std::vector<float> pixels(12);
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, pixels.data()));
  const std::vector<float> top_down{ 0, 0, 0.25f, 1.6e38f, 0, 0, 0, 0, 0, 1000, 3, 0.5f };
  for (std::size_t pixel = 0; pixel < 4; ++pixel)
  {
    const float* want = &top_down[3 * pixel];
    const float largest = *std::max_element(want, want + 3);
    for (std::size_t c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(pixels[3 * pixel + c], want[c], largest / 128) << pixel << ", " << c;
    }
  }
  EXPECT_NE(error_of([&] { write_hdr({ 1, 2, 3 }, 2, 2, path); }), "");
}

TEST(FilmIo, ErrorsNameThePlaceAndTheRemedy)
{
  const std::string here = folder();
  const Film film(2, 2);
  const auto exr = [&](const std::string& path)
  { return error_of([&] { write_exr(film, path); }); };
  EXPECT_NE(exr(here + "a.jpg").find(".png, .exr or .hdr"), std::string::npos);
  EXPECT_NE(exr(here + "a").find(".png, .exr or .hdr"), std::string::npos);
  EXPECT_NE(exr(here + "a.png").find("does not end in .exr"), std::string::npos);
  EXPECT_NE(exr(here + "none/a.exr").find("make the folder first"), std::string::npos);
  std::filesystem::create_directory(here + "dir.exr");
  EXPECT_NE(exr(here + "dir.exr").find("is a folder"), std::string::npos);
  EXPECT_EQ(exr(here + "none/a.exr").substr(0, here.size()), here);
  EXPECT_NE(error_of([&] { write_exr(Film(), here + "a.exr"); }), "");
  Film odd(2, 2);
  odd.transmittance[1].pop_back();
  EXPECT_NE(error_of([&] { write_exr(odd, here + "a.exr"); }), "");
  EXPECT_NE(error_of([&] { write_png({ 1, 2, 3 }, 2, 2, here + "a.png"); }), "");
  EXPECT_NE(error_of([&] { write_png({ 1, 2, 3 }, 1, 1, here + "a.png", { NAN }); }), "");
  EXPECT_NE(error_of([&] { read_exr(here + "missing.exr"); }).find("no such file"), std::string::npos);
  EXPECT_NE(error_of([&] { read_exr(save(here + "bad.exr", "not an exr")); }), "");
  if (geteuid() != 0)
  {
    std::filesystem::create_directory(here + "locked");
    std::filesystem::permissions(here + "locked", std::filesystem::perms::owner_read);
    EXPECT_NE(exr(here + "locked/a.exr"), "");
    std::filesystem::permissions(here + "locked", std::filesystem::perms::owner_all);
  }
}

TEST(FilmIo, FailingWriteKeepsTheOldFile)
{
  const std::string here = folder();
  const std::string path = save(here + "a.exr", "old");
  Film film(64, 64);
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    film.radiance[0][i] = std::sin(static_cast<float>(i)); // does not pack below the limit
  }
  // A limit on the size of files stands for a full disk.
  struct rlimit old;
  getrlimit(RLIMIT_FSIZE, &old);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = old;
  small.rlim_cur = 1000;
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string error = error_of([&] { write_exr(film, path); });
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(error.find("writing failed"), std::string::npos) << error;
  EXPECT_EQ(load(path), "old");
  EXPECT_EQ(files_in(here), 1u);
}
