// Hard cases of cameras: on a face, inside, at a light, nearly flat or nearly all-round, planes far
// apart.
#include "ray_integrators.h"
#include "ray_mappers.h"

#include "vtkBrumeSmartVolumeMapper.h"

#include "Transport/path_tracer.h"
#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <limits>

using namespace stability;
using brume_tests::HardCase;

namespace
{

constexpr int edge = 9; // pixels; the middle one's ray is the camera's axis

/// A homogeneous ball of voxels' box, seen by any view: chords in long double.
struct BoxScene
{
  Voxels<float> voxels{ 9, 9, 9, [](int, int, int) { return 1.0f; } };
  Scene scene;
  double extinction;

  explicit BoxScene(double sigma = 0.25)
    : extinction(sigma)
  {
    scene.volumes[0].grid = voxels.grid();
    scene.volumes[0].meaning = ValueMeaning::Density;
    scene.volumes[0].density.extinction = sigma;
  }

  /// What passes along a pixel's ray, if the box is so much wider. A ray that runs in a face by the
  /// camera's numbers may, by their rounding, be on either side of it.
  double truth(const View& view, int x, int y, long double wider) const
  {
    long double from[3], to[3];
    view.ray(x, y, edge, edge, from, to);
    long double s0 = 0.0L, s1 = 1.0L, square = 0.0L;
    for (int axis = 0; axis < 3; ++axis)
    {
      const long double p = from[axis] + view.centre[axis];
      const long double d = to[axis] - from[axis];
      square += d * d;
      if (d == 0.0L)
      {
        if (p < -wider || p > 8.0L + wider)
        {
          return 1.0;
        }
        continue;
      }
      const long double low = (-wider - p) / d;
      const long double high = (8.0L + wider - p) / d;
      s0 = std::max(s0, std::min(low, high));
      s1 = std::min(s1, std::max(low, high));
    }
    return s0 < s1 ? std::exp(-extinction * static_cast<double>(std::sqrt(square) * (s1 - s0)))
                   : 1.0;
  }
};

/// Every pixel of a view against its chord, by the reference and by each rule on each target.
void measure_view(HardCase& hard_case, BoxScene& box, const View& view, double bound)
{
  box.scene.camera = view.camera(1.0);
  const auto worst = [&](const Film& film)
  {
    double most = 0.0;
    for (int y = 0; y < edge; ++y)
    {
      for (int x = 0; x < edge; ++x)
      {
        const double passes = film.transmittance[0][static_cast<std::size_t>(y) * edge + x];
        const double most_passes = box.truth(view, x, y, -1e-9L);
        const double least_passes = box.truth(view, x, y, 1e-9L);
        const double off =
          passes > least_passes ? std::max(passes - most_passes, 0.0) : least_passes - passes;
        most = off <= most ? most : off;
      }
    }
    return most;
  };
  Film film(edge, edge);
  render_reference(box.scene, {}, film);
  hard_case.measure(worst(film), bound, "of white", "reference");
  Scene lit = box.scene;
  lit.volumes[0].medium.lit = true;
  lit.lights.resize(1);
  for (const std::string& target : targets())
  {
    ASSERT_TRUE(force_simd_target(target));
    for (const StepRule rule : { StepRule::Midpoint, StepRule::Cells })
    {
      MarchSettings settings;
      settings.rule = rule;
      settings.step = 0.41;
      settings.leave_error = 0.0;
      Marcher marcher;
      marcher.render(box.scene, settings, film);
      hard_case.measure(worst(film), bound, "of white", step_rule_name(rule));
    }
    MarchSettings settings;
    settings.step = 0.41;
    settings.leave_error = 0.0;
    settings.shadows = ShadowMethod::Rays;
    Marcher marcher;
    marcher.render(lit, settings, film);
    hard_case.measure(worst(film), bound, "of white", "lit");
    hard_case.holds(all_finite(film), "light is finite", "lit");
    force_simd_target("");
  }
  PathSettings paths;
  paths.samples_per_pixel = 4;
  PathTracer tracer;
  tracer.render(lit, paths, film);
  hard_case.measure(worst(film), bound, "of white", "paths");
  hard_case.holds(all_finite(film), "light is finite", "paths");
  if (view.half_height > view.distance * std::tan(89.5 / 180.0 * pi))
  {
    return; // no vtkCamera sees more than 179 degrees
  }
  for (const Scene* scene : { static_cast<const Scene*>(&box.scene), static_cast<const Scene*>(&lit) })
  {
    for (const NamedMapper& one : new_mappers(0.41, 4, scene == &lit ? 0.01 : 1e-6))
    {
      const Film picture = MapperScene(one.mapper, *scene, vtk_camera(view)).film(edge);
      // The smart mapper's tolerance, where it is lit, is that of light.
      const bool by_tolerance = scene == &lit && one.name == "vtkBrumeSmartVolumeMapper";
      hard_case.measure(worst(picture),
        by_tolerance ? 0.01 : bound,
        by_tolerance ? "of white by a tolerance" : "of white",
        one.name);
      hard_case.holds(all_finite(picture), "light is finite", one.name);
    }
  }
}

}

TEST(Cameras, OnAFace)
{
  HardCase face("Rays",
    "a camera on a face, on an edge, at a corner of the box",
    "rays begin where the box does: to one side all of them miss, to the other none does",
    "the closed form of each pixel's chord, in a box known to 1e-9 voxels");
  for (const glm::dvec3& eye : { glm::dvec3(4.0, 4.0, 8.0),
         glm::dvec3(0.0, 3.0, 4.5),
         glm::dvec3(8.0, 8.0, 4.0),
         glm::dvec3(0.0, 0.0, 0.0),
         glm::dvec3(8.0, 0.0, 8.0) })
  {
    for (const glm::dvec3& forward : { glm::dvec3(0.0, 0.0, -1.0),
           glm::dvec3(1.0, 0.0, 0.0),
           glm::dvec3(0.5, -0.3, 0.8),
           glm::dvec3(-1.0, -1.0, 0.25) })
    {
      View view;
      view.forward = forward;
      view.up = std::abs(forward.y) < 0.5 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
      view.distance = 3.0;
      view.half_height = 2.0;
      view.centre = eye + glm::normalize(forward) * 3.0;
      view.near_plane = 1e-3;
      view.far_plane = 40.0;
      BoxScene box;
      measure_view(face, box, view, 5e-6);
    }
  }
}

TEST(Cameras, Inside)
{
  HardCase inside("Rays",
    "a camera inside the matter",
    "rays begin at the near plane, not at the box",
    "the closed form from the near plane on");
  for (const bool parallel : { false, true })
  {
    View view;
    view.centre = { 4.1, 3.9, 4.3 };
    view.forward = { 0.3, 0.4, -0.7 };
    view.distance = 0.5;
    view.half_height = 1.0;
    view.parallel = parallel;
    view.near_plane = 0.01;
    view.far_plane = 60.0;
    BoxScene box;
    measure_view(inside, box, view, 5e-6);
    view.centre = { 4.0, 4.0, 3.5 }; // the eye on a voxel, along an axis
    view.forward = { 0.0, 0.0, -1.0 };
    measure_view(inside, box, view, 5e-6);
  }
}

TEST(Cameras, Angles)
{
  HardCase angles("Rays",
    "view angles from 1e-6 to 179.9 degrees",
    "rays that are all but parallel, and rays that are all but in the near plane",
    "the closed form of each pixel's chord; by mappers up to the 179 degrees that a vtkCamera has");
  for (const double degrees : { 1e-6, 1e-3, 1.0, 90.0, 170.0, 179.9 })
  {
    View view;
    view.centre = { 4.0, 4.0, 4.0 };
    view.forward = { 0.2, -0.4, -0.9 };
    const double tangent = std::tan(degrees / 360.0 * pi);
    view.half_height = std::min(7.0, 30.0 * tangent);
    view.distance = view.half_height / tangent;
    view.near_plane = std::max(view.distance - 12.0, 1e-3);
    view.far_plane = view.distance + 12.0;
    BoxScene box;
    // A camera 1e8 boxes away: its matrix has lost eight of its digits.
    measure_view(angles, box, view, degrees < 1e-4 ? 1e-4 : 1e-5);
  }
}

TEST(Cameras, PlanesFarApart)
{
  HardCase planes("Rays",
    "near and far planes apart by up to 1e12",
    "a place between them is a ratio of numbers that differ by as many digits",
    "the closed form within 1e-5 of white up to a ratio of 1e9; 2e-3 at 1e12, which costs twelve "
    "of double's "
    "sixteen digits");
  for (const double ratio : { 1e3, 1e6, 1e9, 1e12 })
  {
    View view;
    view.centre = { 4.0, 4.0, 4.0 };
    view.forward = { 0.2, -0.4, -0.9 };
    view.distance = 20.0;
    view.half_height = 7.0;
    view.near_plane = 1e4 / ratio;
    view.far_plane = 1e4;
    BoxScene box;
    measure_view(planes, box, view, ratio < 1e10 ? 1e-5 : 2e-3);
  }
}

TEST(Cameras, AtALight)
{
  HardCase lamp("Rays",
    "a camera at a lamp, and rays through it",
    "the distance to the lamp is 0 where the ray begins; there a lamp of 1/d² is brighter than "
    "anything, and "
    "what is drawn by 1/d² of an even one is drawn in the wrong places",
    "finite, and the reference's light");
  for (int number = 0; number < 4; ++number)
  {
    const bool within = number & 1;
    const bool pure = number & 2;
    BoxScene box(0.1);
    Scene& scene = box.scene;
    scene.volumes[0].medium.lit = true;
    Light light;
    light.positional = true;
    light.position = within ? glm::dvec3(4.0, 4.0, 5.0) : glm::dvec3(4.0, 4.0, 12.0);
    light.attenuation = { pure ? 0.0 : 1.0, 0.0, 0.5 };
    scene.lights = { light };
    View view;
    view.centre = { 4.0, 4.0, 2.0 };
    view.distance = light.position.z - 2.0; // the eye is at the lamp
    view.half_height = 1.5;
    view.near_plane = 1e-3;
    view.far_plane = 30.0;
    scene.camera = view.camera(1.0);
    Film truth(edge, edge);
    ReferenceSettings reference;
    reference.tolerance = 1e-5;
    render_reference(scene, reference, truth);
    lamp.holds(all_finite(truth), "finite", "reference");
    double brightest = 0.0;
    for (float value : truth.radiance[0])
    {
      brightest = std::max(brightest, double(value));
    }
    Film film(edge, edge);
    for (const std::string& target : targets())
    {
      ASSERT_TRUE(force_simd_target(target));
      MarchSettings settings;
      settings.step = 0.125;
      settings.leave_error = 0.0;
      settings.shadows = ShadowMethod::Rays;
      Marcher marcher;
      marcher.render(scene, settings, film);
      lamp.holds(all_finite(film), "finite", "marcher");
      lamp.measure(
        difference(film, truth) / std::max(brightest, 1.0), 2e-3, "of the brightest", "marcher");
      force_simd_target("");
    }
    PathSettings paths;
    paths.samples_per_pixel = 256;
    paths.most_scatterings = 1;
    PathTracer tracer;
    tracer.render(scene, paths, film);
    lamp.holds(all_finite(film), "finite", "paths");
    double worst = 0.0;
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      // The reference, too, has an error where 1/d² begins so near.
      const double error = std::hypot(film.error[i] / 3.0, 3e-4 * truth.radiance[0][i]);
      worst = std::max(worst, std::abs(film.radiance[0][i] - truth.radiance[0][i]) / error);
    }
    // The noise of so few paths beside a lamp is not Gaussian.
    lamp.measure(worst, 6.0, "standard errors of 256 paths", "paths");
    for (const NamedMapper& one : new_mappers(0.125, 64, 0.01))
    {
      if (auto* smart = vtkBrumeSmartVolumeMapper::SafeDownCast(one.mapper))
      {
        smart->SetTimeBudget(0.1); // paths beside a lamp take long to any tolerance
      }
      const Film picture = MapperScene(one.mapper, scene, vtk_camera(view)).film(edge);
      lamp.holds(all_finite(picture), "finite", one.name);
      if (one.name == "vtkBrumeRayMarchMapper")
      {
        lamp.measure(difference(picture, truth) / std::max(brightest, 1.0),
          2e-3,
          "of the brightest",
          one.name);
      }
    }
  }
}

TEST(Cameras, BrokenMatrices)
{
  HardCase broken("Rays",
    "camera and prop matrices that are singular, infinite or NaN",
    "there are no rays to speak of",
    "refused, or nothing is drawn: no hang, no crash, no pixel that is NaN");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  std::vector<glm::dmat4> matrices = { glm::dmat4(0.0), glm::dmat4(nan), glm::dmat4(infinite) };
  for (int column = 0; column < 4; ++column)
  {
    for (const double value : { 0.0, nan, infinite, 1e300, 1e-300 })
    {
      glm::dmat4 m(1.0);
      m[column] *= value;
      matrices.push_back(m);
    }
  }
  for (const glm::dmat4& m : matrices)
  {
    for (int where = 0; where < 3; ++where)
    {
      BoxScene box;
      View view;
      view.centre = { 4.0, 4.0, 4.0 };
      view.distance = 20.0;
      view.far_plane = 60.0;
      Scene& scene = box.scene;
      scene.camera = view.camera(1.0);
      (where == 0    ? scene.camera.clip_from_world
        : where == 1 ? scene.volumes[0].data_from_index
                     : scene.volumes[0].world_from_data) *= m;
      scene.volumes[0].medium.lit = true;
      scene.lights.resize(1);
      const auto draw = [&](const std::string& by, auto render)
      {
        Film film(5, 5);
        bool sane = true;
        try
        {
          render(film);
          for (int c = 0; c < 3; ++c)
          {
            for (std::size_t i = 0; i < film.size(); ++i)
            {
              sane = sane && film.transmittance[c][i] >= 0.0f && film.transmittance[c][i] <= 1.0f &&
                     std::isfinite(film.radiance[c][i]);
            }
          }
        }
        catch (const std::invalid_argument&)
        {
        }
        broken.holds(sane, "refused or sane", by);
      };
      draw("reference", [&](Film& film) { render_reference(scene, {}, film); });
      draw("paths",
        [&](Film& film)
        {
          PathSettings paths;
          paths.samples_per_pixel = 4;
          paths.most_scatterings = 16;
          PathTracer().render(scene, paths, film);
        });
      for (const std::string& target : { targets().front(), targets().back() })
      {
        ASSERT_TRUE(force_simd_target(target));
        draw("lit", [&](Film& film) { Marcher().render(scene, {}, film); });
        draw("cells",
          [&](Film& film)
          {
            Scene unlit = scene;
            unlit.volumes[0].medium.lit = false;
            MarchSettings settings;
            settings.rule = StepRule::Cells;
            Marcher().render(unlit, settings, film);
          });
        force_simd_target("");
      }
      if (where == 0)
      {
        continue; // a vtkCamera is made of places and angles
      }
      for (const NamedMapper& one : new_mappers(0.5, 4, 0.01))
      {
        broken.holds(MapperScene(one.mapper, scene, vtk_camera(view)).refused_or_sane(5),
          "refused or sane",
          one.name);
      }
    }
  }
}
