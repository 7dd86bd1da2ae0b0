// A ball of voxels under a sun: the trilinear field that the voxels are, integrated cell by cell
// with Boost's quadratures, and the ball that they stand for, within what voxels can do.
#include "../support/lit_scenes.h"

#include <boost/math/quadrature/gauss.hpp>

#include <iostream>

using namespace lit_scenes;

namespace
{

/// What it sends.
struct Ball : LitBall
{
  using LitBall::LitBall;

  double sigma() const { return scene.volumes[0].density.extinction; }

  /// Trilinear, written as a sum of weights; 0 outside of the voxels.
  double value(const glm::dvec3& world) const
  {
    const glm::dvec3 p = world + 0.5 * (n - 1);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner)
    {
      std::size_t index = 0;
      double weight = 1.0;
      for (int axis = 2; axis >= 0; --axis)
      {
        if (p[axis] < 0.0 || p[axis] > n - 1)
        {
          return 0.0;
        }
        const int low = std::min(static_cast<int>(p[axis]), n - 2);
        const bool upper = corner >> axis & 1;
        weight *= upper ? p[axis] - low : low + 1.0 - p[axis];
        index = index * n + low + upper;
      }
      sum += weight * voxels.values[index];
    }
    return sum;
  }

  /// Where a line crosses the planes between cells, from `from` to `to`; p + t d.
  std::vector<double> crossings(const glm::dvec3& p,
    const glm::dvec3& d,
    double from,
    double to) const
  {
    std::vector<double> cuts{ from, to };
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int plane = 0; plane < n; ++plane)
      {
        const double t = (plane - 0.5 * (n - 1) - p[axis]) / d[axis];
        if (t > from && t < to)
        {
          cuts.push_back(t);
        }
      }
    }
    std::sort(cuts.begin(), cuts.end());
    return cuts;
  }

  double depth(const glm::dvec3& p, const glm::dvec3& d, double from, double to) const
  {
    const std::vector<double> cuts = crossings(p, d, from, to);
    double sum = 0.0;
    for (std::size_t i = 1; i < cuts.size(); ++i)
    {
      sum += boost::math::quadrature::gauss<double, 7>::integrate(
        [&](double t) { return value(p + t * d); }, cuts[i - 1], cuts[i]);
    }
    return sigma() * sum;
  }

  double scatters(const glm::dvec3& direction) const
  {
    const Light& sun = scene.lights[0];
    return pi * phase(scene.volumes[0].medium, -glm::dot(sun.direction, direction));
  }

  /// The integral of the trilinear field.
  double radiance(const WorldRay& ray) const
  {
    const glm::dvec3 to_sun = -scene.lights[0].direction;
    const double reach = 2.0 * n;
    const double middle = -glm::dot(ray.begin, ray.direction);
    const std::vector<double> cuts = crossings(ray.begin, ray.direction, middle - n, middle + n);
    double sum = 0.0;
    double before = 0.0;
    for (std::size_t i = 1; i < cuts.size(); ++i)
    {
      const auto sends = [&](double t)
      {
        const glm::dvec3 place = ray.begin + t * ray.direction;
        const double here = value(place);
        return here > 0.0 ? sigma() * here *
                              std::exp(-before - depth(ray.begin, ray.direction, cuts[i - 1], t) -
                                       depth(place, to_sun, 0.0, reach))
                          : 0.0;
      };
      const double half = 0.5 * (cuts[i - 1] + cuts[i]);
      using Rule = boost::math::quadrature::gauss<double, 10>;
      sum += Rule::integrate(sends, cuts[i - 1], half) + Rule::integrate(sends, half, cuts[i]);
      before += depth(ray.begin, ray.direction, cuts[i - 1], cuts[i]);
    }
    return sum * scatters(ray.direction);
  }

  /// The integral of the ball itself.
  double round_radiance(const WorldRay& ray) const
  {
    const auto chord = [&](const glm::dvec3& p, const glm::dvec3& d, double& from, double& to)
    {
      const double b = glm::dot(p, d);
      const double root = b * b - glm::dot(p, p) + radius * radius;
      from = -b - std::sqrt(std::max(root, 0.0));
      to = -b + std::sqrt(std::max(root, 0.0));
      return root > 0.0;
    };
    double from, to;
    if (!chord(ray.begin, ray.direction, from, to))
    {
      return 0.0;
    }
    return scatters(ray.direction) * integral(
                                       [&](double t)
                                       {
                                         const glm::dvec3 place = ray.begin + t * ray.direction;
                                         double unused, out;
                                         chord(place, -scene.lights[0].direction, unused, out);
                                         return sigma() * std::exp(-sigma() * (t - from + out));
                                       },
                                       from,
                                       to);
  }
};

constexpr int edge = 12;

double worst_against_field(const Draw& draw, const Ball& ball, double least_white = 1e-30)
{
  return worst_error(
    draw(ball.scene, edge, edge),
    [&](int x, int y)
    {
      const WorldRay ray = world_ray(ball.view, x, y, edge, edge);
      const double middle = -glm::dot(ray.begin, ray.direction);
      const double passes =
        std::exp(-ball.depth(ray.begin, ray.direction, middle - ball.n, middle + ball.n));
      return Truth{ glm::dvec3(ball.radiance(ray)), glm::dvec3(passes) };
    },
    least_white);
}

}

TEST(LitBall, ReferenceIsTheIntegralOfTheVoxels)
{
  const Ball ball(14, 5.2, 0.5);
  EXPECT_LE(worst_against_field(by_reference(1e-7), ball), 2e-6);
}

TEST(LitBall, Marched)
{
  const Ball ball(14, 5.2, 0.5);
  const auto look = [&](
                      const char* name, const Draw& draw, double bound, double least_white = 1e-30)
  {
    const double error = worst_against_field(draw, ball, least_white);
    EXPECT_LE(error, bound) << name;
    std::cout << "  " << name << ": " << error << "\n";
  };
  look("shadow rays, steps of a voxel", by_marcher(ShadowMethod::Rays, 1.0), 0.03);
  look("shadow rays, short steps", by_marcher(ShadowMethod::Rays, 1.0 / 64.0), 1e-5);
  look("light volume, nodes of a voxel", by_marcher(ShadowMethod::Volume, 1.0 / 64.0, 1.0), 0.08);
  look("light volume, nodes of 1/8", by_marcher(ShadowMethod::Volume, 1.0 / 64.0, 0.125), 1e-3);
  look("functions, texels of a voxel", by_marcher(ShadowMethod::Functions, 1.0 / 64.0, 1.0), 0.09);
  look("functions, texels of 1/8", by_marcher(ShadowMethod::Functions, 1.0 / 64.0, 0.125), 0.02);
  look("tolerance 1e-3", by_tolerance(1e-3), 1e-3, 1.0);
  look("tolerance 1e-5", by_tolerance(1e-5), 1e-5, 1.0);
}

// Twice as many voxels across halve what the soft edge does to the picture.
TEST(LitBall, VoxelsConvergeToTheBall)
{
  double errors[2];
  for (const int level : { 0, 1 })
  {
    const int n = level ? 62 : 32;
    const double radius = level ? 26.0 : 13.0;
    const Ball ball(n, radius, 4.0 / radius);
    const Film film = by_reference(1e-4)(ball.scene, edge, edge);
    double sum = 0.0;
    double most = 0.0;
    int inside = 0;
    for (int y = 0; y < edge; ++y)
    {
      for (int x = 0; x < edge; ++x)
      {
        const WorldRay ray = world_ray(ball.view, x, y, edge, edge);
        const double truth = ball.round_radiance(ray);
        const double away = glm::length(glm::cross(ray.begin, ray.direction)) / radius;
        if (away > 0.9) // the rim is a soft edge, not a ball
        {
          continue;
        }
        ++inside;
        most = std::max(most, truth);
        sum += std::abs(film.radiance[1][y * edge + x] - truth);
      }
    }
    ASSERT_GT(inside, 20);
    errors[level] = sum / inside / most;
  }
  std::cout << "mean error by the brightest: " << errors[0] << ", " << errors[1] << "\n";
  EXPECT_LE(errors[0], 0.02);
  EXPECT_LE(errors[1], 0.55 * errors[0]);
}
