// What is known of light that is scattered any number of times, and how means of paths are held
// against it.
#pragma once

#include "lit_scenes.h"

#include "Transport/path_tracer.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <cmath>
#include <cstdlib>
#include <vector>

namespace path_truth
{

using namespace lit_scenes;

/// The share of the paths that full tests trace: the environment variable BRUME_PATHS, 1 for the
/// published accuracy of 0.1 %, else a sixteenth, and few under sanitizers.
inline double effort()
{
  const char* text = std::getenv("BRUME_PATHS");
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  const double usual = 1.0 / 256.0;
#else
  const double usual = 1.0 / 16.0;
#endif
  return text ? std::max(std::atof(text), 1e-3) : usual;
}

/// Standard errors that a mean may be off. Of some fifty checks one is beyond three now and then,
/// with another processor's last digits.
inline double most_off()
{
  return std::getenv("BRUME_PATHS") ? 3.0 : 4.5;
}

struct Mean
{
  glm::dvec3 value{ 0.0 };
  glm::dvec3 error{ 0.0 }; ///< standard error
};

/// Of all pixels, whose rays must be alike: mean and standard error, by how pixels differ.
inline Mean mean_of(const Film& film)
{
  Mean mean;
  const double count = static_cast<double>(film.size());
  for (int c = 0; c < 3; ++c)
  {
    double sum = 0.0;
    double squares = 0.0;
    for (float v : film.radiance[c])
    {
      sum += v;
      squares += double(v) * v;
    }
    mean.value[c] = sum / count;
    mean.error[c] =
      std::sqrt(std::max(squares / count - mean.value[c] * mean.value[c], 0.0) / (count - 1.0));
  }
  return mean;
}

/// A picture by paths.
inline Film traced(const Scene& scene, const PathSettings& settings, int width, int height)
{
  Film film(width, height);
  PathTracer tracer;
  EXPECT_TRUE(tracer.render(scene, settings, film).completed);
  return film;
}

/// A view of parallel rays, all but the same one: through `place` along `forward`.
inline View pencil(const glm::dvec3& place, const glm::dvec3& forward, double distance)
{
  View view;
  view.centre = place;
  view.forward = glm::normalize(forward);
  view.up = std::abs(view.forward.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(0.0, 1.0, 0.0);
  view.distance = distance;
  view.half_height = 1e-9;
  view.parallel = true;
  view.far_plane = 2.0 * distance;
  return view;
}

/// Chandrasekhar's H function for isotropic scattering: 1 / H(μ) = √(1 − ω) + ω/2 ∫ μ′ H(μ′) / (μ +
/// μ′) dμ′ over [0, 1] (S. Chandrasekhar, Radiative Transfer, 1960, § 38), by iteration on a rule
/// of Gauss and Kronrod's nodes.
class HFunction
{
public:
  explicit HFunction(double albedo)
    : Albedo(albedo)
  {
    using Rule = boost::math::quadrature::gauss_kronrod<double, 61>;
    const auto& x = Rule::abscissa();
    const auto& w = Rule::weights();
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      for (double side : { -1.0, 1.0 })
      {
        if (i > 0 || side > 0.0)
        {
          this->Nodes.push_back(0.5 * (1.0 + side * x[i]));
          this->Weights.push_back(0.5 * w[i]);
        }
      }
    }
    this->Values.assign(this->Nodes.size(), 1.0);
    double change = 1.0;
    for (int turn = 0; turn < 100000 && change > 1e-13; ++turn)
    {
      change = 0.0;
      for (std::size_t i = 0; i < this->Nodes.size(); ++i)
      {
        const double next = 0.5 * (this->Values[i] + (*this)(this->Nodes[i]));
        change = std::max(change, std::abs(next - this->Values[i]));
        this->Values[i] = next;
      }
    }
  }

  double operator()(double mu) const
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < this->Nodes.size(); ++i)
    {
      sum += this->Weights[i] * this->Nodes[i] * this->Values[i] / (mu + this->Nodes[i]);
    }
    return 1.0 / (std::sqrt(1.0 - this->Albedo) + 0.5 * this->Albedo * sum);
  }

private:
  double Albedo;
  std::vector<double> Nodes;
  std::vector<double> Weights;
  std::vector<double> Values;
};

/// The fluence of a lamp that sends the power 1 to all sides, at a distance in infinite matter of
/// extinction 1 that scatters isotropically with an albedo 0 < c < 1: K. M. Case, P. F. Zweifel,
/// Linear Transport Theory, 1967, § 2.8,
///
///   φ(r) = (2 κ² (1 − κ²) / (c (κ² + c − 1)) e^(−κr) + ∫₀¹ g(μ) e^(−r/μ) dμ/μ²) / 4πr,
///   1/g = (1 − c μ artanh μ)² + (π c μ / 2)²,   κ = c artanh κ.
class InfiniteMedium
{
public:
  explicit InfiniteMedium(double albedo)
    : Albedo(albedo)
  {
    // By the distance from 1, which may be tiny.
    double low = 1e-300;
    double high = 1.0;
    for (int i = 0; i < 2000; ++i)
    {
      const double middle = std::sqrt(low * high);
      const double kappa = 1.0 - middle;
      const double atanh = 0.5 * std::log((2.0 - middle) / middle);
      (kappa > albedo * atanh ? high : low) = middle;
    }
    this->Kappa = 1.0 - low;
    const double k2 = this->Kappa * this->Kappa;
    this->Discrete = 2.0 * k2 * low * (2.0 - low) / (albedo * (k2 + albedo - 1.0));
  }

  double fluence(double r) const
  {
    const double c = this->Albedo;
    // μ = 1 / (1 + t / r): dμ/μ² = −dt / r.
    const auto continuum = [&](double t)
    {
      const double mu = r / (r + t);
      const double one_minus = t / (r + t);
      const double atanh = 0.5 * std::log((1.0 + mu) / one_minus);
      const double a = 1.0 - c * mu * atanh;
      const double b = 0.5 * pi * c * mu;
      return std::exp(-t) / (a * a + b * b);
    };
    const double sum = integral(continuum, 0.0, 1e-3) + integral(continuum, 1e-3, 1.0) +
                       integral(continuum, 1.0, 40.0);
    return (this->Discrete * std::exp(-this->Kappa * r) + std::exp(-r) / r * sum) / (4.0 * pi * r);
  }

private:
  double Albedo;
  double Kappa;
  double Discrete;
};

}
