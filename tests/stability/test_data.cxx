// Hard cases of data and transfer functions, through the mappers.
#include "hard_case.h"
#include "mapper_stage.h"

#include "Transport/reference.h"

#include "vtkDoubleArray.h"

#include <functional>
#include <limits>

using namespace mapper_stage;
using brume_tests::HardCase;

namespace
{

const double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

/// A ball of values from 0 to 200 of which some voxels are something else.
vtkSmartPointer<vtkImageData> spoilt_ball(double spoil)
{
  auto image = ball_image(VTK_FLOAT, 20);
  vtkDataArray* values = image->GetPointData()->GetScalars();
  for (vtkIdType i = 3; i < values->GetNumberOfTuples(); i += 37)
  {
    values->SetComponent(i, 0, spoil);
  }
  return image;
}
constexpr int spoilt = (20 * 17 * 22 - 4) / 37 + 1;

/// As density and classified; each mapper, and the march with each SIMD target.
void for_each_meaning(const std::function<void(Stage&, const std::string&)>& run)
{
  for (const bool density : { false, true })
  {
    for_each_mapper(
      [&](Stage& stage, const std::string& by)
      {
        if (auto* march = vtkBrumeRayMarchMapper::SafeDownCast(stage.mapper))
        {
          march->SetAutoAdjustSampleDistances(0);
          march->SetSampleDistance(0.25);
        }
        if (density)
        {
          stage.mapper->SetExtinction(0.002);
        }
        run(stage, by);
      });
  }
}

/// Of a picture whose pixels all see the same.
void expect_even_radiance(HardCase& one,
  const Stage& stage,
  const Film& film,
  double truth,
  const std::string& by)
{
  if (!stage.mapper->IsA("vtkBrumePathTraceMapper"))
  {
    one.measure(std::abs(film.radiance[0][middle] - truth), 1e-5, "absolute", by);
    return;
  }
  // Paths find light by chance: the mean of all pixels, by their own scatter.
  double sum = 0.0;
  double squares = 0.0;
  for (const float v : film.radiance[0])
  {
    sum += v;
    squares += double(v) * v;
  }
  const double count = static_cast<double>(film.size());
  const double mean = sum / count;
  const double error = std::sqrt(std::max(squares / count - mean * mean, 1e-12) / (count - 1.0));
  one.measure(std::abs(mean - truth) / error, 4.5, "standard errors", by);
}

}

TEST(Data, VoxelsThatAreNoNumbers)
{
  const struct
  {
    const char* name;
    double value;
  } cases[] = {
    { "NaN voxels", not_a_number }, { "infinite voxels", infinity }, { "voxels of −∞", -infinity }
  };
  for (const auto& each : cases)
  {
    HardCase one("Data",
      each.name,
      "one in an interpolation of eight spreads to all around it, and one in a brick's range hides "
      "or shows the brick",
      "they are empty: the picture is that of voxels of a value of no opacity, and the statistics "
      "count them");
    for_each_meaning(
      [&](Stage& stage, const std::string& by)
      {
        stage.show(spoilt_ball(0.0)); // 0 is the first value of no opacity, and no density
        const Film clean = stage.film();
        stage.show(spoilt_ball(each.value));
        const Film film = stage.film();
        one.measure(difference(film, clean), 1e-6, "of white", by);
        one.holds(in_bounds(film), "in bounds", by);
        one.holds(stage.number("non_finite_voxels") == spoilt, "counted", by);
      });
  }
}

TEST(Data, NothingButNaN)
{
  HardCase one("Data",
    "a volume of nothing but NaN",
    "it has no range of values to build tables over",
    "nothing is drawn: transmittance 1, radiance 0, exactly; all voxels are counted");
  for_each_meaning(
    [&](Stage& stage, const std::string& by)
    {
      auto image = ball_image(VTK_FLOAT, 8);
      image->GetPointData()->GetScalars()->Fill(not_a_number);
      stage.show(image);
      const Film film = stage.film();
      one.measure(opacity_or_light(film), 0.0, "of opacity or light", by);
      one.holds(stage.number("non_finite_voxels") == image->GetNumberOfPoints(), "counted", by);
    });
}

TEST(Data, Denormals)
{
  HardCase one("Data",
    "a density of denormals, 1e-40, with an extinction of 1e38",
    "registers that flush denormals to 0 see nothing; the product of both is an ordinary 0.01",
    "the transmittance of e^(−0.01 · way) within 1e-4");
  for_each_mapper(
    [&](Stage& stage, const std::string& by)
    {
      stage.show(constant_image(VTK_FLOAT, 1e-40));
      stage.mapper->SetExtinction(1e38);
      const double truth = std::exp(-1e38 * double(1e-40f) * constant_depth);
      one.measure(std::abs(stage.film().transmittance[0][middle] - truth), 1e-4, "absolute", by);
    });
}

TEST(Data, MinusZero)
{
  HardCase one("Data",
    "voxels of −0",
    "its sign passes through products and bit tricks with floats",
    "the same picture as of +0, bit for bit");
  for_each_meaning(
    [&](Stage& stage, const std::string& by)
    {
      stage.show(spoilt_ball(0.0));
      const Film plus = stage.film();
      stage.show(spoilt_ball(-0.0));
      one.measure(difference(stage.film(), plus), 0.0, "of white", by);
    });
}

TEST(Data, NegativeDensity)
{
  HardCase one("Data",
    "negative densities",
    "matter that makes light: transmittance above 1; a kink inside a cell, where interpolation "
    "passes 0",
    "they count as 0: all negative is nothing, exactly; beside positive ones within 0.004 of the "
    "reference, and never above 1");
  for_each_mapper(
    [&](Stage& stage, const std::string& by)
    {
      stage.mapper->SetExtinction(0.002);
      stage.show(constant_image(VTK_FLOAT, -5.0));
      one.measure(opacity_or_light(stage.film()), 0.0, "of opacity where all is negative", by);
      stage.show(spoilt_ball(-30.0));
      const Film film = stage.film();
      one.holds(in_bounds(film), "in bounds", by);
      // Where paths and the smart mapper march with a fixed step, or promise 99.9 % of the pixels.
      const bool march = stage.mapper->IsA("vtkBrumeRayMarchMapper");
      one.measure(difference(film, stage.reference()),
        march ? 0.004 : 0.02,
        march ? "of white" : "of white by the other mappers",
        by);
    });
}

TEST(Data, Constants)
{
  HardCase one("Data",
    "constant volumes of 0, 7, −1e30, 1e30 and 3e38",
    "the range of values is empty: a table's scale divides by it",
    "the opacity and the colour of that one value, within 1e-5; by paths within 4.5 standard "
    "errors");
  for (const double value : { 0.0, 7.0, -1e30, 1e30, 3e38 })
  {
    for_each_mapper(
      [&](Stage& stage, const std::string& by)
      {
        stage.show(constant_image(VTK_FLOAT, value));
        // The function knows other values, too.
        stage.opacities({ { value - 0.5 * std::max(1.0, std::abs(value)), 0.0 }, { value, 0.5 } });
        stage.colours({ { value, 0.25 } });
        stage.unit(constant_depth);
        const Film film = stage.film();
        one.measure(std::abs(film.transmittance[0][middle] - 0.5), 1e-5, "absolute", by);
        expect_even_radiance(one, stage, film, 0.125, by);
      });
  }
}

TEST(Data, ExtremesOfEveryType)
{
  HardCase one("Data",
    "the least and the largest value of each of VTK's 12 numeric types, side by side",
    "max − min overflows the type; 2⁶⁴ − 1 and 1e308 have no float of their own",
    "the least is clear, the largest of opacity ½ within 1e-4; doubles beyond 3.4e38 count as "
    "that, not as infinite");
  for (const int type : { VTK_CHAR,
         VTK_SIGNED_CHAR,
         VTK_UNSIGNED_CHAR,
         VTK_SHORT,
         VTK_UNSIGNED_SHORT,
         VTK_INT,
         VTK_UNSIGNED_INT,
         VTK_LONG,
         VTK_UNSIGNED_LONG,
         VTK_LONG_LONG,
         VTK_UNSIGNED_LONG_LONG,
         VTK_FLOAT,
         VTK_DOUBLE })
  {
    for_each_mapper(
      [&](Stage& stage, const std::string& by)
      {
        auto image = constant_image(type, 0.0);
        vtkDataArray* values = image->GetPointData()->GetScalars();
        // Of doubles the floats' ends are what is drawn.
        const double widest = std::numeric_limits<float>::max();
        const double least = values->GetDataTypeMin();
        const double most = values->GetDataTypeMax();
        // The left half of the picture has the least, the right half the largest.
        for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
        {
          const bool right = i % constant_size >= constant_size / 2;
          values->SetComponent(i, 0, right ? most : least);
        }
        if (type == VTK_LONG || type == VTK_LONG_LONG || type == VTK_UNSIGNED_LONG ||
            type == VTK_UNSIGNED_LONG_LONG)
        {
          set_whole_extremes(values);
        }
        stage.show(image);
        stage.opacities({ { std::max(least, -widest), 0.0 }, { std::min(most, widest), 0.5 } });
        stage.unit(constant_depth);
        const Film film = stage.film();
        one.measure(std::abs(film.transmittance[0][left_pixel] - 1.0), 1e-4, "absolute", by);
        one.measure(std::abs(film.transmittance[0][right_pixel] - 0.5), 1e-4, "absolute", by);
        one.holds(stage.number("non_finite_voxels") == 0.0, "none counted as not finite", by);
      });
  }
}

TEST(Data, OneLitVoxelIn512Cubed)
{
  HardCase one("Data",
    "one lit voxel in 512³, seen in whole and from near",
    "steps are chosen by a few rays, which all miss it; bricks are leapt over by their ranges",
    "every mapper finds it: the opacity through its middle within 0.01 of the closed form of a "
    "density, within 0.02 (0.06 by the smart mapper) of the reference where it is classified");
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(512, 512, 512);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  auto* voxels = static_cast<unsigned char*>(image->GetScalarPointer());
  std::fill(voxels, voxels + (std::size_t(1) << 27), static_cast<unsigned char>(0));
  const int place[3] = { 301, 203, 417 };
  voxels[(std::size_t(place[2]) * 512 + place[1]) * 512 + place[0]] = 255;
  for_each_mapper(
    [&](Stage& stage, const std::string& by)
    {
      stage.show(image);
      stage.mapper->SetExtinction(2.0 / 255.0); // ∫ over the tent is 255 voxels
      const double truth = -std::expm1(-2.0);
      for (const double half_height : { 260.0, 2.5 })
      {
        // A pixel a voxel.
        stage.look_down(
          half_height == 2.5 ? glm::dvec3(place[0], place[1], place[2]) : glm::dvec3(255.5),
          half_height);
        const int edge = half_height == 2.5 ? 5 : 520;
        Film film = stage.film(edge);
        one.measure(std::abs(most_opaque(film) - truth), 0.01, "of opacity", by);
      }
      // Classified: the highest values alone are seen, of a voxel less than a third.
      stage.mapper->SetExtinction(0.0);
      stage.opacities({ { 0.0, 0.0 }, { 170.0, 0.0 }, { 255.0, 0.9 } });
      stage.unit(1.0);
      stage.look_down(glm::dvec3(255.5), 260.0);
      const double seen = most_opaque(stage.film(520));
      stage.look_down(glm::dvec3(place[0], place[1], place[2]), 2.5);
      // One of 270 400 pixels is less than the thousandth that the smart mapper leaves out.
      const double bound = stage.mapper->IsA("vtkBrumeSmartVolumeMapper") ? 0.06 : 0.02;
      const double wanted = most_opaque(stage.reference(5));
      one.measure(std::abs(seen - wanted), bound, "of opacity where it is classified", by);
      one.measure(std::abs(most_opaque(stage.film(5)) - wanted),
        bound,
        "of opacity where it is classified",
        by);
    },
    false);
}

TEST(Data, EmptyVolumes)
{
  HardCase one("Data",
    "volumes without voxels: no input, no points, no scalars, fewer scalars than points, spacing "
    "of 0 or NaN, an origin of NaN",
    "sizes of 0 pass through divisions and allocations; a NaN in a matrix makes every ray NaN",
    "refused with an error that names what is wrong; nothing is drawn, and the next picture is "
    "whole");
  const struct
  {
    const char* part;
    std::function<vtkSmartPointer<vtkImageData>()> make;
  } cases[] = {
    { "no image data", []() { return vtkSmartPointer<vtkImageData>(); } },
    { "scalars", []() { return vtkSmartPointer<vtkImageData>::New(); } },
    { "scalars",
      []()
      {
        auto image = vtkSmartPointer<vtkImageData>::New();
        image->SetDimensions(4, 4, 4);
        return image;
      } },
    { "values for",
      []()
      {
        auto image = constant_image(VTK_FLOAT, 1.0);
        vtkNew<vtkFloatArray> few;
        few->SetNumberOfTuples(5);
        few->Fill(1.0);
        image->GetPointData()->SetScalars(few);
        return image;
      } },
    { "spacing",
      []()
      {
        auto image = constant_image(VTK_FLOAT, 1.0);
        image->SetSpacing(1.0, 0.0, 1.0);
        return image;
      } },
    { "spacing",
      []()
      {
        auto image = constant_image(VTK_FLOAT, 1.0);
        image->SetSpacing(1.0, not_a_number, 1.0);
        return image;
      } },
    { "origin",
      []()
      {
        auto image = constant_image(VTK_FLOAT, 1.0);
        image->SetOrigin(0.0, 0.0, not_a_number);
        return image;
      } },
  };
  for (const auto& each : cases)
  {
    for_each_mapper(
      [&](Stage& stage, const std::string& by)
      {
        stage.show(constant_image(VTK_FLOAT, 1.0)); // the camera looks at something
        stage.mapper->SetInputDataObject(each.make());
        one.refuses(stage.refused(), each.part, by);
        stage.show(constant_image(VTK_FLOAT, 1.0));
        stage.opacities({ { 0.0, 0.5 } });
        one.holds(most_opaque(stage.film()) > 0.1, "recovers", by);
      },
      false);
  }
}

TEST(Data, AllTransparent)
{
  HardCase one("Data",
    "transfer functions that make everything transparent: all 0, below 0, or without a single "
    "point",
    "nothing is visible, and everything asks for where something is",
    "transmittance 1 and radiance 0, exactly");
  const std::vector<Stage::Points> cases = {
    { { 0.0, 0.0 }, { 255.0, 0.0 } }, { { 0.0, -1.0 }, { 255.0, -0.0 } }, {}
  };
  for (const auto& points : cases)
  {
    for_each_mapper(
      [&](Stage& stage, const std::string& by)
      {
        stage.show(ball_image(VTK_UNSIGNED_CHAR, 20));
        stage.opacities(points);
        one.measure(opacity_or_light(stage.film()), 0.0, "of opacity or light", by);
      });
  }
}

TEST(Data, AllOpaque)
{
  HardCase one("Data",
    "transfer functions that make everything opaque: opacity 1 and beyond",
    "the extinction −ln(1 − 1)/d is infinite",
    "1 − 1e-16 of a unit distance counts: behind five of them nothing passes, and the radiance is "
    "the first "
    "voxels' colour within 1e-5");
  for (const double opacity : { 1.0, 7.0 })
  {
    for_each_mapper(
      [&](Stage& stage, const std::string& by)
      {
        stage.show(constant_image(VTK_UNSIGNED_CHAR, 9.0));
        stage.opacities({ { 0.0, opacity }, { 255.0, opacity } });
        stage.colours({ { 0.0, 0.75 }, { 255.0, 0.75 } });
        stage.unit(1.0);
        const Film film = stage.film();
        one.holds(in_bounds(film), "in bounds", by);
        one.measure(film.transmittance[0][middle],
          1e-3,
          "of white passes",
          by); // what leaving rays early leaves
        one.measure(std::abs(film.radiance[0][middle] - 0.75), 1e-3, "of white", by);
      });
  }
}

TEST(Data, FunctionsOfOnePoint)
{
  HardCase one("Data",
    "transfer functions of a single point, in the data's range, below and above it",
    "there is no interval between two nodes to build a table over, and VTK's own colour table is "
    "black at the point",
    "the point's opacity and colour everywhere, within 1e-5; by paths within 4.5 standard errors");
  for (const double at : { -1000.0, 7.0, 9.0, 1e6 })
  {
    for_each_mapper(
      [&](Stage& stage, const std::string& by)
      {
        auto image = constant_image(VTK_FLOAT, 7.0);
        image->GetPointData()->GetScalars()->SetComponent(0, 0, 9.0);
        stage.show(image);
        stage.opacities({ { at, 0.5 } });
        stage.colours({ { at, 0.25 } });
        stage.unit(constant_depth);
        const Film film = stage.film();
        one.measure(std::abs(film.transmittance[0][middle] - 0.5), 1e-5, "absolute", by);
        expect_even_radiance(one, stage, film, 0.125, by);
      });
  }
}

TEST(Data, Steps)
{
  HardCase one("Data",
    "a transfer function with a step: from 0 to opaque between two neighbouring numbers",
    "any step of the ray straddles it; a table's node may lie on either side",
    "within the mapper's tolerance of 0.004 of the reference for 99 of 100 pixels (0.02 by paths, "
    "whose "
    "transmittance has a fixed step), and everywhere within 0.05");
  for_each_mapper(
    [&](Stage& stage, const std::string& by)
    {
      stage.show(ball_image(VTK_FLOAT, 20));
      const double edge = 100.0;
      stage.opacities(
        { { 0.0, 0.0 }, { edge, 0.0 }, { std::nextafter(edge, 200.0), 0.6 }, { 200.0, 0.6 } });
      stage.unit(4.0);
      const Film film = stage.film(24);
      const Film truth = stage.reference(24);
      std::vector<double> errors;
      for (std::size_t i = 0; i < film.size(); ++i)
      {
        errors.push_back(std::abs(film.transmittance[0][i] - truth.transmittance[0][i]));
      }
      std::sort(errors.begin(), errors.end());
      // Paths' transmittance is marched with a fixed step of an eighth of a voxel.
      const bool fixed = stage.mapper->IsA("vtkBrumePathTraceMapper");
      one.measure(errors[errors.size() * 99 / 100],
        fixed ? 0.02 : 0.004,
        fixed ? "of white for 99 of 100 by a fixed step" : "of white for 99 of 100",
        by);
      one.measure(errors.back(), 0.05, "of white, worst", by);
      one.holds(in_bounds(film), "in bounds", by);
    },
    false);
}

TEST(Data, UnsortedPoints)
{
  HardCase one("Data",
    "transfer functions whose points come unsorted, and twice",
    "a table is filled from left to right",
    "the same picture as of sorted ones, bit for bit; of two points at one place the later counts");
  for_each_mapper(
    [&](Stage& stage, const std::string& by)
    {
      stage.show(ball_image(VTK_UNSIGNED_CHAR, 12));
      stage.opacities({ { 20.0, 0.0 }, { 90.0, 0.3 }, { 140.0, 0.1 }, { 200.0, 0.5 } });
      stage.colours({ { 0.0, 0.1 }, { 120.0, 0.9 }, { 200.0, 0.4 } });
      const Film sorted = stage.film();
      stage.opacities(
        { { 140.0, 0.9 }, { 200.0, 0.5 }, { 20.0, 0.0 }, { 140.0, 0.1 }, { 90.0, 0.3 } });
      stage.colours({ { 200.0, 0.4 }, { 0.0, 0.1 }, { 120.0, 0.2 }, { 120.0, 0.9 } });
      one.measure(difference(stage.film(), sorted), 0.0, "of white", by);
    },
    false);
}

TEST(Data, PointsThatAreNoNumbers)
{
  HardCase one("Data",
    "transfer functions with NaN or infinite points, places or colours",
    "NaN has no place in a sorted list, passes through clamps, and one colour of it makes every "
    "pixel NaN",
    "refused with an error that names the function; nothing is drawn, and the next picture is "
    "whole");
  const struct
  {
    Stage::Points opacities;
    Stage::Points colours;
    const char* part;
  } cases[] = {
    { { { 0.0, 0.0 }, { 100.0, not_a_number } }, { { 0.0, 1.0 } }, "opacity" },
    { { { 0.0, 0.0 }, { not_a_number, 0.5 }, { 50.0, 0.1 } }, { { 0.0, 1.0 } }, "opacity" },
    { { { 0.0, 0.0 }, { infinity, 0.5 } }, { { 0.0, 1.0 } }, "opacity" },
    { { { 0.0, 0.5 } }, { { 0.0, 1.0 }, { 100.0, not_a_number } }, "colour" },
    { { { 0.0, 0.5 } }, { { 0.0, 1.0 }, { not_a_number, 0.5 } }, "colour" },
    { { { 0.0, 0.5 } }, { { 0.0, infinity }, { 100.0, 1.0 } }, "colour" },
  };
  for (const auto& each : cases)
  {
    for_each_mapper(
      [&](Stage& stage, const std::string& by)
      {
        stage.show(ball_image(VTK_UNSIGNED_CHAR, 12));
        stage.opacities(each.opacities);
        stage.colours(each.colours);
        one.refuses(stage.refused(), each.part, by);
        stage.opacities({ { 0.0, 0.5 } });
        stage.colours({ { 0.0, 0.5 } });
        one.holds(most_opaque(stage.film()) > 0.1, "recovers", by);
      },
      false);
  }
}

TEST(Data, UnitDistances)
{
  HardCase one("Data",
    "opacity unit distances of 0, below 0, NaN",
    "the extinction is divided by it",
    "refused with an error that names it; nothing is drawn, and the next picture is whole");
  HardCase ends("Data",
    "opacity unit distances of 1e-30 and 1e30",
    "extinctions of 1e30 and 1e-30, and steps as deep",
    "opaque and clear, within 1e-3 and 1e-6");
  for_each_mapper(
    [&](Stage& stage, const std::string& by)
    {
      stage.show(constant_image(VTK_UNSIGNED_CHAR, 9.0));
      stage.opacities({ { 0.0, 0.5 } });
      stage.colours({ { 0.0, 0.5 } });
      for (const double distance : { 0.0, -0.0, -2.0, not_a_number })
      {
        stage.unit(distance);
        one.refuses(stage.refused(), "unit distance", by);
      }
      stage.unit(1.0);
      one.holds(most_opaque(stage.film()) > 0.1, "recovers", by);
      stage.unit(1e-30);
      const Film opaque = stage.film();
      ends.measure(opaque.transmittance[0][middle], 1e-3, "of white passes where it is opaque", by);
      ends.measure(std::abs(opaque.radiance[0][middle] - 0.5), 1e-3, "of white", by);
      ends.holds(in_bounds(opaque), "in bounds", by);
      stage.unit(1e30);
      ends.measure(opacity_or_light(stage.film()), 1e-6, "of white where it is clear", by);
    });
}

TEST(Data, SettingsThatAreNoNumbers)
{
  HardCase one("Data",
    "an extinction and a tolerance of NaN or infinity",
    "NaN passes VTK's clamps, as every comparison with it is false",
    "refused with a warning or an error, or cut to the range: never a picture that is not finite");
  for_each_mapper(
    [&](Stage& stage, const std::string& by)
    {
      stage.show(ball_image(VTK_UNSIGNED_CHAR, 12));
      for (const double bad : { not_a_number, infinity, -infinity })
      {
        for (const bool extinction : { true, false })
        {
          stage.mapper->SetExtinction(extinction ? bad : 0.01);
          stage.mapper->SetTolerance(extinction ? 0.004 : bad);
          Film film(size, size);
          stage.mapper->RenderFilm(stage.volume, stage.camera, nullptr, film);
          one.holds(in_bounds(film), "finite and in bounds", by);
        }
      }
    },
    false);
}
