// Raw voxels, and beside them the JSON file that says what they are (docs/user/input.md).
#include "image_file.h"

#include "atomic_file.h"
#include "header_text.h"

#include <nlohmann/json.hpp>

namespace brume::io
{

void write_raw(ImageFile& image, const std::string& path)
{
  const std::array<double, 9> d = image.direction();
  nlohmann::ordered_json json;
  if (!image.array.empty())
  {
    json["array"] = image.array;
  }
  json["dimensions"] = image.dimensions;
  json["type"] = scalar_name(image.scalar);
  json["byte_order"] = machine_is_big_endian() ? "big" : "little";
  json["components"] = image.components;
  json["spacing"] = image.spacing();
  json["origin"] = { image.affine[3], image.affine[7], image.affine[11] };
  json["direction"] = { { d[0], d[1], d[2] }, { d[3], d[4], d[5] }, { d[6], d[7], d[8] } };
  if (image.patient)
  {
    json["patient_axes"] = true;
  }
  if (!image.length_unit.empty())
  {
    json["unit"] = image.length_unit;
  }
  if (!image.value_unit.empty())
  {
    json["value_unit"] = image.value_unit;
  }
  const std::string text =
    json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  // Two files cannot be moved at once: the voxels first, which nothing reads without the other.
  AtomicFile voxels(path);
  AtomicFile sidecar(path + ".json");
  write_plain(voxels, image);
  sidecar.write(text.data(), text.size());
  voxels.commit();
  sidecar.commit();
}

}
