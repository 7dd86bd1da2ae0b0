#include "colour_map.h"

#include <vtkColorTransferFunction.h>
#include <vtkNew.h>

#include <algorithm>
#include <cmath>

namespace brume
{

namespace
{

unsigned char byte(double v)
{
  return static_cast<unsigned char>(std::lround(255.0 * std::clamp(v, 0.0, 1.0)));
}

constexpr int table_size = 512;
using Table = std::array<Colour, table_size + 1>;

Table cool_warm_table()
{
  vtkNew<vtkColorTransferFunction> map;
  map->SetColorSpaceToDiverging();
  map->AddRGBPoint(-1.0, 0.230, 0.299, 0.754);
  map->AddRGBPoint(1.0, 0.706, 0.016, 0.150);
  Table table;
  for (int i = 0; i <= table_size; ++i)
  {
    double rgb[3];
    map->GetColor(2.0 * i / table_size - 1.0, rgb);
    table[i] = { byte(rgb[0]), byte(rgb[1]), byte(rgb[2]) };
  }
  return table;
}

}

Colour inferno(double t)
{
  static constexpr double c[7][3] = {
    { 0.0002189403691192265, 0.001651004631001012, -0.01948089843709184 },
    { 0.1065134194856116, 0.5639564367884091, 3.932712388889277 },
    { 11.60249308247187, -3.972853965665698, -15.9423941062914 },
    { -41.70399613139459, 17.43639888205313, 44.35414519872813 },
    { 77.162935699427, -33.40235894210092, -81.80730925738993 },
    { -71.31942824499214, 32.62606426397723, 73.20951985803202 },
    { 25.13112622477341, -12.24266895238567, -23.07032500287172 },
  };
  t = std::clamp(t, 0.0, 1.0);
  Colour colour;
  for (int channel = 0; channel < 3; ++channel)
  {
    double v = 0.0;
    for (int power = 6; power >= 0; --power)
    {
      v = v * t + c[power][channel];
    }
    colour[channel] = byte(v);
  }
  return colour;
}

Colour cool_warm(double t)
{
  static const Table table = cool_warm_table();
  t = std::clamp(t, -1.0, 1.0);
  return table[static_cast<std::size_t>(std::lround((t + 1.0) / 2.0 * table_size))];
}

}
