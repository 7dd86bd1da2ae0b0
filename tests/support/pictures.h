// TIFF and PNG files for the tests, written by OpenImageIO.
#pragma once

#include <OpenImageIO/imageio.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace pictures
{

/// Pages of one size; pages[p][i + width * j] is a number of the page's pixel, row 0 at the top.
template <class T>
void write(const std::string& path, int width, int height, const std::vector<std::vector<T>>& pages,
  const std::string& description = {}, float per_cm = 0)
{
  OIIO::ImageSpec spec(width, height, 1, OIIO::TypeDescFromC<T>::value());
  if (!description.empty())
  {
    spec["ImageDescription"] = description;
  }
  if (per_cm > 0)
  {
    spec["XResolution"] = per_cm;
    spec["YResolution"] = per_cm;
    spec["ResolutionUnit"] = "cm";
  }
  const auto out = OIIO::ImageOutput::create(path);
  const std::vector<OIIO::ImageSpec> specs(pages.size(), spec);
  bool good = out != nullptr;
  if (good && pages.size() == 1)
  {
    good = out->open(path, spec);
  }
  else if (good)
  {
    good = out->open(path, static_cast<int>(specs.size()), specs.data());
  }
  for (std::size_t p = 0; good && p < pages.size(); ++p)
  {
    good = (p == 0 || out->open(path, spec, OIIO::ImageOutput::AppendSubimage)) &&
      out->write_image(spec.format, pages[p].data());
  }
  if (!good || !out->close())
  {
    throw std::runtime_error("the test cannot write " + path + ": " + (out ? out->geterror() : ""));
  }
}

}
