#include "Transport/reference_lighting.h"

#include "Transport/black_body.h"
#include "Transport/exponential_integral.h"
#include "Transport/optics.h"
#include "Transport/reference_integrators.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace brume
{

namespace
{

constexpr double pi = 3.14159265358979323846;

scalar::Vec3<double> to_scalar(const glm::dvec3& v)
{
  return { v.x, v.y, v.z };
}

/// Extinctions of volumes in one place, added up.
class Mix
{
public:
  void add(const glm::dvec3& extinction)
  {
    this->Sum += extinction;
    this->Squares += extinction * extinction;
  }
  glm::dvec3 total(Mixture mixture) const
  {
    glm::dvec3 result = this->Sum;
    for (int c = 0; c < 3 && mixture == Mixture::Components; ++c)
    {
      result[c] = this->Sum[c] > 0.0 ? this->Squares[c] / this->Sum[c] : 0.0;
    }
    return result;
  }

private:
  glm::dvec3 Sum{ 0.0 };
  glm::dvec3 Squares{ 0.0 };
};

glm::dvec3 channels(const Volume& volume)
{
  return volume.meaning == ValueMeaning::Density ? volume.density.channels : glm::dvec3(1.0);
}

bool shines(const glm::dvec3& light)
{
  return light.x > 0.0 || light.y > 0.0 || light.z > 0.0;
}

/// Maps [from, to] to [first, last], and what is outside to the ends.
double remap(double x, double from, double to, double first, double last)
{
  return first + (last - first) * std::clamp((x - from) / (to - from), 0.0, 1.0);
}

}

bool needs_lighting(const Scene& scene)
{
  return scene.blend_mode == BlendMode::Composite &&
         (has_fog(scene) ||
           std::any_of(scene.volumes.begin(),
             scene.volumes.end(),
             [](const Volume& volume)
             { return volume.medium.lit || channels(volume) != glm::dvec3(1.0); }));
}

struct ReferenceLighting::Arriving
{
  struct Beam
  {
    glm::dvec3 offset;     ///< Lamp::offset
    glm::dvec3 irradiance; ///< unshadowed
    glm::dvec3 depth;      ///< optical depth on the way
    double one_minus_cosine;
    double one_plus_cosine;
  };
  std::vector<Beam> beams; ///< as many as lamps
  glm::dvec3 ambient;      ///< mean radiance from all around, shadowed
  glm::dvec3 world;
  glm::dvec3 toward_eye;
};

struct ReferenceLighting::Body
{
  const ReferenceMedium* matter;
  std::vector<PhaseModel> octaves;
  ShadeModel unlit;                ///< without a light
  std::vector<ShadeModel> by_lamp; ///< with one light each, and no ambient light
  std::unique_ptr<ReferenceGrid> temperature;
  glm::dvec4 height{ 0.0 }; ///< h = height · (world place, 1)

  const Volume& volume() const { return this->matter->volume(); }
  const Medium& medium() const { return this->matter->volume().medium; }

  void find_height(const Sky& sky);
  double powder(const FoundMatter& found, const glm::dvec3& world) const;
  /// The ambient light that is scattered.
  glm::dvec3 ambient(const FoundMatter& found, const Arriving& light) const;
  glm::dvec3 scattered(const FoundMatter& found, const Arriving& light) const;
  glm::dvec3 shaded(const FoundMatter& found, const Arriving& light) const;
  glm::dvec3 emitted(const FoundMatter& found, const glm::dvec3& place) const;
};

ReferenceLighting::~ReferenceLighting() = default;

ReferenceLighting::ReferenceLighting(const Scene& scene, const std::vector<ReferenceMedium>& media)
  : TheScene(scene)
  , Media(media)
  , Rays(scene)
{
  for (const Light& light : scene.lights)
  {
    this->Lamps.emplace_back(light);
  }
  for (const ReferenceMedium& matter : media)
  {
    Body body;
    body.matter = &matter;
    const Medium& medium = matter.volume().medium;
    double factor = 1.0;
    for (int m = 0; m < std::max(medium.octaves.count, 1); ++m)
    {
      body.octaves.push_back(prepare_phase(medium.lobes, factor));
      factor *= medium.octaves.anisotropy;
    }
    add_silver_lining(medium.silver_lining, body.octaves.front());
    body.unlit = matter.shade();
    body.unlit.lights.clear();
    ShadeModel one = matter.shade();
    std::fill(one.ambient, one.ambient + 3, 0.0f);
    for (ShadeLight light : matter.shade().lights)
    {
      std::fill(light.position, light.position + 3, 0.0f);
      one.lights.assign(1, light);
      body.by_lamp.push_back(one);
    }
    if (medium.black_body > 0.0 && medium.temperature.voxels)
    {
      black_body_radiance(0.0, medium.black_body_reference); // throws for one that is not usable
      body.temperature = ReferenceGrid::make(medium.temperature, 0.0);
    }
    body.find_height(scene.sky);
    this->Bodies.push_back(std::move(body));
  }
  if (has_fog(scene))
  {
    this->Fog = std::make_unique<FogModel>(scene);
    this->FogPhase = prepare_phase(scene.fog.lobes);
  }
}

glm::dvec3 ReferenceLighting::sent_by_fog(const Arriving& light) const
{
  glm::dvec3 sum = light.ambient;
  for (const Arriving::Beam& beam : light.beams)
  {
    sum += beam.irradiance * glm::exp(-beam.depth) *
           scalar::phase<double>(this->FogPhase, beam.one_minus_cosine, beam.one_plus_cosine);
  }
  return this->TheScene.fog.albedo * sum;
}

void ReferenceLighting::Body::find_height(const Sky& sky)
{
  const Grid& grid = this->volume().grid;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (int corner = 0; corner < 8; ++corner)
  {
    glm::dvec4 place(1.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = corner >> axis & 1 ? grid.upper(axis) : grid.lower(axis);
    }
    const glm::dvec4 world =
      this->volume().world_from_data * (this->volume().data_from_index * place);
    const double height = glm::dot(sky.up, glm::dvec3(world));
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  const double scale = highest > lowest ? 1.0 / (highest - lowest) : 0.0;
  this->height = glm::dvec4(sky.up * scale, -lowest * scale);
}

double ReferenceLighting::Body::powder(const FoundMatter& found, const glm::dvec3& world) const
{
  const Powder& powder = this->medium().powder;
  if (!powder.enabled)
  {
    return 1.0;
  }
  double density = found.value;
  if (!this->matter->is_density())
  {
    density = opacity_from_optical_depth(
      found.extinction * this->volume().weight * this->volume().classification.unit_distance);
  }
  const double d = std::clamp(powder.scale * density, 0.0, 1.0);
  if (powder.form == Powder::Form::Exponential)
  {
    return 1.0 - powder.strength * std::exp(-2.0 * d);
  }
  const double h = glm::dot(this->height, glm::dvec4(world, 1.0));
  const double inside =
    std::clamp(powder.strength * std::pow(d, remap(h, 0.3, 0.9, 0.5, 1.0)), 0.0, 1.0);
  return 1.0 - inside * std::pow(remap(h, 0.0, 0.3, 0.8, 1.0), 0.8);
}

glm::dvec3 ReferenceLighting::Body::ambient(const FoundMatter& found, const Arriving& light) const
{
  return this->medium().albedo * found.colour * light.ambient * this->powder(found, light.world);
}

/// Lights through the phase function; like the following, per unit of extinction.
glm::dvec3 ReferenceLighting::Body::scattered(const FoundMatter& found, const Arriving& light) const
{
  const Octaves& octaves = this->medium().octaves;
  glm::dvec3 sum(0.0);
  double contribution = 1.0;
  double attenuation = 1.0;
  for (const PhaseModel& model : this->octaves)
  {
    for (const Arriving::Beam& beam : light.beams)
    {
      sum +=
        beam.irradiance * glm::exp(-attenuation * beam.depth) *
        (contribution * scalar::phase<double>(model, beam.one_minus_cosine, beam.one_plus_cosine));
    }
    contribution *= octaves.contribution;
    attenuation *= octaves.attenuation;
  }
  return this->medium().albedo * found.colour * sum * this->powder(found, light.world);
}

/// As scattered(), where shading takes the place of the phase function: matter of the albedo's
/// colour, and powder leaves it alone.
glm::dvec3 ReferenceLighting::Body::shaded(const FoundMatter& found, const Arriving& light) const
{
  using scalar::Vec3;
  const Vec3<double> gradient = to_scalar(this->matter->world_from_gradient() * found.gradient);
  const Vec3<double> viewer = to_scalar(light.toward_eye);
  const Vec3<double> colour = to_scalar(this->medium().albedo * found.colour);
  glm::dvec3 sum(0.0);
  const auto add = [&](const ShadeModel& model, const glm::dvec3& place, const glm::dvec3& passes)
  {
    const Vec3<double> sends =
      scalar::shade<double>(model, gradient, viewer, to_scalar(place), colour);
    sum += glm::dvec3(sends.x, sends.y, sends.z) * passes;
  };
  add(this->unlit, glm::dvec3(0.0), glm::dvec3(1.0));
  for (std::size_t l = 0; l < light.beams.size(); ++l)
  {
    add(this->by_lamp[l], light.beams[l].offset, glm::exp(-light.beams[l].depth));
  }
  return sum;
}

/// Per unit of the data's length.
glm::dvec3 ReferenceLighting::Body::emitted(const FoundMatter& found, const glm::dvec3& place) const
{
  const Medium& medium = this->medium();
  glm::dvec3 radiance = medium.emission;
  if (this->temperature)
  {
    radiance += medium.black_body *
                black_body_radiance(medium.temperature_scale *
                                      this->temperature->value(place, medium.temperature.component),
                  medium.black_body_reference);
  }
  return this->matter->is_density() ? radiance * std::max(found.value, 0.0)
                                    : radiance * found.colour * found.extinction;
}

ReferenceLighting::Arriving ReferenceLighting::arriving(const PixelRay& ray,
  double s,
  int pieces,
  std::uint64_t& samples) const
{
  Arriving result;
  result.world = ray.world_place(s);
  result.toward_eye = -glm::normalize(ray.world_along);
  // From here on there is no more matter.
  const double outside = glm::distance(result.world, this->Rays.centre()) + this->Rays.radius();
  for (const Lamp& lamp : this->Lamps)
  {
    Arriving::Beam beam{};
    beam.offset = lamp.offset(result.world);
    const glm::dvec3 travel = lamp.travel(beam.offset);
    beam.irradiance = lamp.irradiance(beam.offset);
    if (this->Fog)
    {
      beam.irradiance *= this->Fog->light_transmittance(result.beams.size(), result.world);
    }
    const glm::dvec3 less = travel - result.toward_eye;
    const glm::dvec3 more = travel + result.toward_eye;
    beam.one_minus_cosine = 0.5 * glm::dot(less, less);
    beam.one_plus_cosine = 0.5 * glm::dot(more, more);
    if (shines(beam.irradiance))
    {
      beam.depth = this->optical_depth(
        result.world, lamp.is_positional() ? -beam.offset : -travel * outside, pieces, samples);
    }
    result.beams.push_back(beam);
  }
  result.ambient = glm::dvec3(0.0);
  const Sky& sky = this->TheScene.sky;
  const bool layers = this->Fog && this->TheScene.fog.falloff > 0.0;
  for (const double side : { 1.0, -1.0 })
  {
    const glm::dvec3& radiance = side > 0.0 ? sky.radiance : sky.ground;
    if (shines(radiance) && !(layers && side < 0.0)) // layers have no lower end
    {
      glm::dvec3 depth =
        this->optical_depth(result.world, sky.up * (side * outside), pieces, samples);
      if (layers)
      {
        depth += this->Fog->optical_depth(
          this->Fog->profile(result.world) / this->TheScene.fog.falloff);
      }
      for (int c = 0; c < 3; ++c)
      {
        result.ambient[c] += 0.5 * radiance[c] * exponential_integral_2(depth[c]);
      }
    }
  }
  return result;
}

Sent ReferenceLighting::sent(const PixelRay& ray,
  const int* volumes,
  std::size_t count,
  double s,
  int pieces,
  std::uint64_t& samples) const
{
  Sent result;
  Mix mix;
  bool has_arrived = false;
  Arriving light;
  for (std::size_t i = 0; i < count; ++i)
  {
    const int v = volumes[i];
    const Body& body = this->Bodies[v];
    const VolumeRay& own = ray.volumes[v];
    const glm::dvec3 place = own.place(s);
    const double length = own.length * body.volume().weight;
    ++samples;
    if (!body.medium().lit)
    {
      const Optical optical = this->Media[v].at(place, own.along);
      const double depth = optical.extinction * length;
      mix.add(depth * channels(body.volume()));
      result.radiance += depth * optical.source;
      continue;
    }
    const FoundMatter found = this->Media[v].matter(place);
    const glm::dvec3 depth = found.extinction * length * channels(body.volume());
    mix.add(depth);
    result.radiance += length * body.emitted(found, place);
    const bool is_shaded = body.volume().shading.enabled && !body.matter->is_density();
    if (!(found.extinction > 0.0) || !(is_shaded || shines(body.medium().albedo * found.colour)))
    {
      continue;
    }
    if (!has_arrived)
    {
      light = this->arriving(ray, s, pieces, samples);
      has_arrived = true;
    }
    result.radiance +=
      depth * (body.ambient(found, light) +
                (is_shaded ? body.shaded(found, light) : body.scattered(found, light)));
  }
  result.extinction = mix.total(this->TheScene.mixture);
  if (this->Fog)
  {
    const glm::dvec3 depth =
      this->Fog->optical_depth(this->Fog->profile(ray.world_place(s)) * ray.world_length);
    if (!has_arrived)
    {
      light = this->arriving(ray, s, pieces, samples);
    }
    result.extinction += depth;
    result.radiance += depth * this->sent_by_fog(light);
  }
  return result;
}

glm::dvec3 ReferenceLighting::optical_depth(const glm::dvec3& from,
  const glm::dvec3& along,
  int pieces,
  std::uint64_t& samples) const
{
  const PixelRay ray = this->Rays.between(from, along);
  glm::dvec3 depth(0.0);
  std::vector<int> visible;
  for (const RayInterval& interval : ray.intervals())
  {
    CellWalk walk({ interval.from, interval.to });
    for (int v : interval.volumes)
    {
      walk.add(ray.volumes[v], this->TheScene.volumes[v]);
    }
    RayPart part;
    while (walk.next(part))
    {
      visible.clear();
      int count = 1;
      for (int v : interval.volumes)
      {
        const VolumeRay& own = ray.volumes[v];
        const ReferenceMedium& medium = this->Media[v];
        const glm::dvec3 middle = own.place(0.5 * (part.from + part.to));
        if (!medium.visible(middle))
        {
          continue;
        }
        visible.push_back(v);
        double lower;
        double upper;
        medium.range(middle, lower, upper);
        if (!medium.is_density() || lower < 0.0) // else a cubic, for which two points are exact
        {
          const double variation = medium.variation(medium.label(middle),
            medium.value(own.place(part.from)),
            medium.value(own.place(part.to)));
          count = std::max(count, pieces * extra_pieces(variation));
        }
      }
      if (visible.empty())
      {
        continue;
      }
      if (visible.size() > 1 && this->TheScene.mixture == Mixture::Components)
      {
        count = std::max(count, pieces);
      }
      const double width = (part.to - part.from) / count;
      for (int point = 0; point < 2 * count; ++point)
      {
        const double offset = point % 2 ? 0.5 + 0.5 / std::sqrt(3.0) : 0.5 - 0.5 / std::sqrt(3.0);
        const double s = part.from + width * (point / 2 + offset);
        Mix mix;
        for (int v : visible)
        {
          const VolumeRay& own = ray.volumes[v];
          const Volume& volume = this->TheScene.volumes[v];
          mix.add(this->Media[v].extinction(own.place(s)) * own.length * volume.weight *
                  channels(volume));
          ++samples;
        }
        depth += 0.5 * width * mix.total(this->TheScene.mixture);
      }
    }
  }
  return depth;
}

}
