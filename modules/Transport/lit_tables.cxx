#include "Transport/lit_tables.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

namespace
{

constexpr double pi = 3.14159265358979323846;

void store3(const glm::dmat3& m, float out[9])
{
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      out[3 * row + column] = static_cast<float>(m[column][row]);
    }
  }
}

void store4(const glm::dmat4& m, float out[12])
{
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      out[4 * row + column] = static_cast<float>(m[column][row]);
    }
  }
}

glm::dmat4 world_from_index(const Volume& volume)
{
  return volume.world_from_data * volume.data_from_index;
}

glm::dvec3 channels_of(const Volume& volume)
{
  return volume.meaning == ValueMeaning::Density ? volume.density.channels : glm::dvec3(1.0);
}

void append(std::vector<double>& key, const glm::dmat4& m)
{
  for (int i = 0; i < 16; ++i)
  {
    key.push_back(m[i / 4][i % 4]);
  }
}

double smallest_edge(const Volume& volume)
{
  double edge = std::numeric_limits<double>::max();
  for (int axis = 0; axis < 3; ++axis)
  {
    edge = std::min(edge, glm::length(glm::dvec3(volume.data_from_index[axis])));
  }
  return edge;
}

/// The edge of a temperature's largest value.
double hottest(const Grid& grid)
{
  double most = 0.0;
  const std::size_t count = grid.voxel_count() * grid.components;
  for (std::size_t i = grid.component; i < count; i += grid.components)
  {
    double value = 0.0;
    switch (grid.type)
    {
      case VoxelType::UInt8:
        value = static_cast<const std::uint8_t*>(grid.voxels)[i];
        break;
      case VoxelType::Int8:
        value = static_cast<const std::int8_t*>(grid.voxels)[i];
        break;
      case VoxelType::UInt16:
        value = static_cast<const std::uint16_t*>(grid.voxels)[i];
        break;
      case VoxelType::Int16:
        value = static_cast<const std::int16_t*>(grid.voxels)[i];
        break;
      case VoxelType::Float32:
        value = static_cast<const float*>(grid.voxels)[i];
        break;
      case VoxelType::Float16: // refused by Grid::validate
        break;
    }
    most = std::isfinite(value) ? std::max(most, value) : most;
  }
  return most;
}

}

bool needs_lit_kernels(const Scene& scene)
{
  return has_fog(scene) || (scene.blend_mode == BlendMode::Composite &&
    std::any_of(scene.volumes.begin(), scene.volumes.end(),
      [](const Volume& v)
      {
        const glm::dvec3 c = channels_of(v);
        return v.medium.lit || c.x != c.y || c.x != c.z || c.x != 1.0;
      }));
}

bool has_exact_shadow_rays(const Scene& scene)
{
  const Volume& volume = scene.volumes[0];
  return scene.volumes.size() == 1 && volume.meaning == ValueMeaning::Density &&
    !volume.mask.labels && volume.grid.linear &&
    (!volume.cropping.enabled || volume.cropping.regions == 0x2000);
}

void LitTables::fill_volume(const Scene& scene, std::size_t k, LitVolume& lit)
{
  const Volume& volume = scene.volumes[k];
  const Medium& medium = volume.medium;
  lit = LitVolume();
  lit.lit = medium.lit;
  const glm::dvec3 channels = channels_of(volume);
  for (int c = 0; c < 3; ++c)
  {
    lit.albedo[c] = static_cast<float>(medium.albedo[c]);
    lit.channels[c] = static_cast<float>(channels[c]);
    lit.emission[c] = static_cast<float>(medium.emission[c]);
  }
  const int octaves = std::clamp(medium.octaves.count, 1, most_octaves);
  double attenuation = 1.0;
  double contribution = 1.0;
  double anisotropy = 1.0;
  for (int m = 0; m < octaves; ++m)
  {
    lit.octaves.push_back({ static_cast<float>(attenuation), static_cast<float>(contribution),
      prepare_phase(medium.lobes, anisotropy) });
    attenuation *= medium.octaves.attenuation;
    contribution *= medium.octaves.contribution;
    anisotropy *= medium.octaves.anisotropy;
  }
  add_silver_lining(medium.silver_lining, lit.octaves[0].phase);
  const bool glows = medium.lit && medium.black_body > 0.0 && medium.temperature.voxels;
  lit.emits = medium.lit && (glows || medium.emission != glm::dvec3(0.0));
  if (glows)
  {
    Glow* glow = this->Glows[k].get();
    // Scanned once for each revision of the voxels.
    const bool known = glow && glow->voxels == medium.temperature.voxels &&
      glow->data_revision == volume.data_revision &&
      glow->medium_revision == volume.medium_revision && volume.data_revision != 0 &&
      volume.medium_revision != 0;
    const double largest = known ? glow->largest : hottest(medium.temperature);
    const double top = largest * medium.temperature_scale;
    if (!glow || glow->hottest != top || glow->reference != medium.black_body_reference)
    {
      this->Glows[k] = std::make_unique<Glow>();
      glow = this->Glows[k].get();
      glow->hottest = top;
      glow->reference = medium.black_body_reference;
      glow->table = make_black_body_table(std::max(top, 1.0), medium.black_body_reference);
    }
    glow->largest = largest;
    glow->voxels = medium.temperature.voxels;
    glow->data_revision = volume.data_revision;
    glow->medium_revision = volume.medium_revision;
    lit.black_body = &glow->table;
    lit.temperature = view_field(medium.temperature, medium.temperature.component, true, 0.0f);
    lit.temperature_scale = static_cast<float>(medium.temperature_scale);
    lit.black_body_scale = static_cast<float>(medium.black_body);
  }
  lit.powder = medium.lit && medium.powder.enabled && medium.powder.strength > 0.0;
  lit.powder_form = medium.powder.form;
  lit.powder_strength = static_cast<float>(medium.powder.strength);
  lit.powder_scale = static_cast<float>(medium.powder.scale);
  lit.unit_distance = static_cast<float>(volume.classification.unit_distance);
  // The height in the volume's box along `up` is linear in index space.
  const glm::dmat4 m = world_from_index(volume);
  const glm::dvec4 up(scene.sky.up, 0.0);
  const glm::dvec4 height = up * m;
  double lowest = std::numeric_limits<double>::max();
  double highest = -lowest;
  for (int corner = 0; corner < 8; ++corner)
  {
    glm::dvec4 place(0.0, 0.0, 0.0, 1.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = corner >> axis & 1 ? volume.grid.upper(axis) : volume.grid.lower(axis);
    }
    lowest = std::min(lowest, glm::dot(height, place));
    highest = std::max(highest, glm::dot(height, place));
  }
  const double span = highest > lowest ? highest - lowest : 1.0;
  for (int i = 0; i < 4; ++i)
  {
    lit.height[i] = static_cast<float>((height[i] - (i == 3 ? lowest : 0.0)) / span);
  }
}

void LitTables::fill_frame(const Scene& scene, std::size_t k, LitFrame& frame) const
{
  const Volume& volume = scene.volumes[k];
  frame = LitFrame();
  const glm::dmat4 m = world_from_index(volume);
  frame.is_first = k == 0 || m == world_from_index(scene.volumes[0]);
  store4(glm::inverse(m) * world_from_index(scene.volumes[0]), frame.from_first);
  store3(glm::dmat3(volume.data_from_index), frame.data_from_index);
  const Cropping& cropping = volume.cropping;
  const bool box = cropping.enabled && cropping.regions == 0x2000;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double lower = volume.grid.lower(axis);
    const double upper = volume.grid.upper(axis);
    frame.lower[axis] = static_cast<float>(box ? std::max(lower, cropping.lower[axis]) : lower);
    frame.upper[axis] = static_cast<float>(box ? std::min(upper, cropping.upper[axis]) : upper);
    frame.rounding[axis] =
      static_cast<float>(1e-6 * (1.0 + std::max(std::abs(lower), std::abs(upper))));
    frame.crop_lower[axis] = static_cast<float>(cropping.lower[axis]);
    frame.crop_upper[axis] = static_cast<float>(cropping.upper[axis]);
  }
  frame.cropped = cropping.enabled && !box;
  frame.regions = cropping.regions;
  for (const glm::dvec4& plane : volume.clipping_planes)
  {
    const glm::dvec4 p = plane * m;
    const double length = glm::length(glm::dvec3(p));
    frame.planes.emplace_back(length > 0.0 ? p / length : p);
  }
}

void LitTables::fill_light(const Scene& scene, const Light& light, LitLight& lit) const
{
  lit = LitLight();
  const glm::dmat4 index_from_world = glm::inverse(world_from_index(scene.volumes[0]));
  const glm::dvec3 toward(index_from_world * glm::dvec4(-light.direction, 0.0));
  const glm::dvec3 place(index_from_world * glm::dvec4(light.position, 1.0));
  lit.source = prepare_light(light);
  std::fill_n(lit.source.position, 3, 0.0f);
  glm::dmat4 offset = world_from_index(scene.volumes[0]);
  offset[3] -= glm::dvec4(light.position, 0.0);
  store4(offset, lit.offset_from_index);
  for (int c = 0; c < 3; ++c)
  {
    lit.irradiance[c] = static_cast<float>(pi * light.diffuse[c]);
    lit.toward[c] = static_cast<float>(toward[c]);
    lit.place[c] = static_cast<float>(place[c]);
  }
}

void LitTables::fill_fog(const Scene& scene)
{
  LitTask& task = this->Task;
  task.fog = FogTask();
  this->TheFog.reset();
  if (!has_fog(scene))
  {
    return;
  }
  this->TheFog.emplace(scene);
  const Fog& fog = scene.fog;
  FogTask& target = task.fog;
  const double largest = std::max({ fog.extinction.x, fog.extinction.y, fog.extinction.z });
  target.enabled = true;
  target.extinction = static_cast<float>(std::min(largest, 1e30));
  target.falloff = static_cast<float>(std::min(fog.falloff, 1e30));
  // The height is linear in index space: multiplied out in double precision, where places far from the
  // origin keep their digits.
  const glm::dvec4 up(scene.sky.up, -fog.base_height);
  const glm::dvec4 exponent = (up * world_from_index(scene.volumes[0])) * fog.falloff;
  for (int i = 0; i < 4; ++i)
  {
    target.exponent[i] = static_cast<float>(exponent[i]);
  }
  LitVolume matter;
  matter.lit = true;
  for (int c = 0; c < 3; ++c)
  {
    matter.albedo[c] = static_cast<float>(fog.albedo[c]);
    matter.channels[c] = static_cast<float>(fog.extinction[c] / largest);
  }
  matter.octaves.push_back({ 1.0f, 1.0f, prepare_phase(fog.lobes) });
  task.volumes.push_back(matter);
  for (std::size_t l = 0; l < task.lights.size(); ++l)
  {
    const Light& light = scene.lights[l];
    LitLight& lit = task.lights[l];
    const double rise = -glm::dot(light.direction, scene.sky.up);
    const double height = glm::dot(light.position, scene.sky.up) - fog.base_height;
    const bool layers = fog.falloff > 0.0;
    lit.fog_hides = layers && !light.positional && !(rise * fog.falloff > 0.0);
    lit.fog_above = layers && !lit.fog_hides
      ? static_cast<float>(std::min(largest / (fog.falloff * rise), 1e30))
      : 0.0f;
    lit.fog_exponent = static_cast<float>(
      std::clamp(fog.falloff * height, double(FogTask::least_exponent), 1e30));
  }
}

void LitTables::find_channels(const Scene& scene)
{
  const glm::dvec3 first = channels_of(scene.volumes[0]);
  const bool same = std::all_of(scene.volumes.begin(), scene.volumes.end(),
    [&](const Volume& v) { return channels_of(v) == first; });
  this->Task.maps = same ? 1 : 3;
  this->Task.chromatic = !same || first.x != first.y || first.x != first.z || first.x != 1.0;
  const glm::dvec3& fog = scene.fog.extinction;
  this->Task.chromatic =
    this->Task.chromatic || (has_fog(scene) && (fog.x != fog.y || fog.x != fog.z));
  for (int c = 0; c < 3; ++c)
  {
    this->Task.channels[c] = same ? static_cast<float>(first[c]) : 1.0f;
  }
}

void LitTables::find_deep_enough(const Scene& scene)
{
  constexpr double thin = 1e-3; // an octave sends no more of the light than it sees of the matter
  LitTask& task = this->Task;
  double thinnest = 1.0;
  for (std::size_t k = 0; k < scene.volumes.size(); ++k)
  {
    for (const LitVolume::Octave& octave : task.volumes[k].octaves)
    {
      thinnest = octave.attenuation > thin ? std::min(thinnest, double(octave.attenuation)) : thinnest;
    }
  }
  double channel = 1.0;
  for (int c = 0; c < 3; ++c)
  {
    task.has_channel[c] = std::any_of(task.volumes.begin(),
      task.volumes.begin() + static_cast<std::ptrdiff_t>(scene.volumes.size()),
      [c](const LitVolume& v) { return v.channels[c] > 0.0f; });
    channel = task.channels[c] > 0.0f ? std::min(channel, double(task.channels[c])) : channel;
  }
  task.deep_enough = static_cast<float>(std::min(30.0 / (thinnest * channel), 1e30));
  task.components = scene.mixture == Mixture::Components && scene.volumes.size() > 1;
}

double LitTables::find_brightest(
  const Scene& scene, const std::vector<VolumeTask>& volumes) const
{
  double most = 0.0;
  for (std::size_t k = 0; k < scene.volumes.size(); ++k)
  {
    const Medium& medium = scene.volumes[k].medium;
    const LitVolume& lit = this->Task.volumes[k];
    if (!lit.lit)
    {
      continue;
    }
    const double colour = volumes[k].table ? std::max(1.0f, volumes[k].table->brightest) : 1.0;
    double source = 0.0;
    for (const Light& light : scene.lights)
    {
      const double irradiance = pi * std::max({ light.diffuse.x, light.diffuse.y, light.diffuse.z });
      double phase = 0.0;
      for (const LitVolume::Octave& octave : lit.octaves)
      {
        phase += octave.contribution * this->largest_phase_toward_camera(scene, light, octave.phase);
      }
      const double strongest =
        light.positional ? 1.0 / std::max(1e-3, light.attenuation.x) : 1.0;
      source += irradiance * strongest * phase;
    }
    const auto largest = [](const glm::dvec3& v) { return std::max({ v.x, v.y, v.z }); };
    source += 0.5 * (largest(scene.sky.radiance) + largest(scene.sky.ground));
    source *= largest(medium.albedo) * colour;
    if (volumes[k].shade.enabled)
    {
      source = std::max(source, colour * volumes[k].shade.brightest);
    }
    // Of emission beside little extinction there is no bound; most has a source of this size.
    source += largest(medium.emission) *
      (volumes[k].table ? colour : 1.0 / std::max(scene.volumes[k].density.extinction, 1e-6));
    if (lit.black_body)
    {
      source += medium.black_body * lit.black_body->brightest *
        (volumes[k].table ? colour : 1.0 / std::max(scene.volumes[k].density.extinction, 1e-6));
    }
    most = std::max(most, source);
  }
  return most;
}

double LitTables::brightest_fog(const Scene& scene) const
{
  if (!this->TheFog)
  {
    return 0.0;
  }
  const PhaseModel phase = prepare_phase(scene.fog.lobes);
  double most = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    double source = 0.5 * (scene.sky.radiance[c] + scene.sky.ground[c]);
    for (const Light& light : scene.lights)
    {
      const double strongest = light.positional ? 1.0 / std::max(1e-3, light.attenuation.x) : 1.0;
      source += pi * light.diffuse[c] * strongest *
        this->largest_phase_toward_camera(scene, light, phase);
    }
    most = std::max(most, scene.fog.albedo[c] * source);
  }
  return most;
}

double LitTables::largest_phase_toward_camera(
  const Scene& scene, const Light& light, const PhaseModel& phase) const
{
  if (light.positional || phase.is_isotropic())
  {
    return largest_phase(phase);
  }
  // The cone around all directions of view, from the picture's corners.
  const glm::dmat4 world_from_clip = glm::inverse(scene.camera.clip_from_world);
  glm::dvec3 directions[5];
  const double x[5] = { 0, -1, 1, -1, 1 };
  const double y[5] = { 0, -1, -1, 1, 1 };
  double widest = 0.0;
  for (int i = 0; i < 5; ++i)
  {
    const glm::dvec4 near_point = world_from_clip * glm::dvec4(x[i], y[i], -1.0, 1.0);
    const glm::dvec4 far_point = world_from_clip * glm::dvec4(x[i], y[i], 1.0, 1.0);
    directions[i] = glm::normalize(
      glm::dvec3(far_point) / far_point.w - glm::dvec3(near_point) / near_point.w);
    widest = std::max(widest,
      std::acos(std::clamp(glm::dot(directions[0], directions[i]), -1.0, 1.0)));
  }
  const double angle = std::acos(
    std::clamp(glm::dot(glm::normalize(light.direction), -directions[0]), -1.0, 1.0));
  if (!std::isfinite(angle + widest))
  {
    return largest_phase(phase);
  }
  const double least = std::cos(std::min(angle + widest, pi));
  const double largest = std::cos(std::max(angle - widest, 0.0));
  return largest_phase(phase, least, largest);
}

void LitTables::update(const Scene& scene,
  const MarchSettings& settings,
  const std::vector<VolumeTask>& volumes,
  int threads,
  const std::function<bool()>& go)
{
  LitTask& task = this->Task;
  const std::size_t count = scene.volumes.size();
  task.volumes.resize(count);
  task.frames.resize(count);
  this->Glows.resize(count);
  const bool lit = has_fog(scene) ||
    std::any_of(
      scene.volumes.begin(), scene.volumes.end(), [](const Volume& v) { return v.medium.lit; });
  bool plain = true;
  for (std::size_t k = 0; k < count; ++k)
  {
    this->fill_volume(scene, k, task.volumes[k]);
    this->fill_frame(scene, k, task.frames[k]);
    const LitVolume& volume = task.volumes[k];
    plain = plain && !volume.emits && !volume.powder && volume.octaves.size() == 1;
  }
  this->find_channels(scene);
  task.lights.resize(lit ? scene.lights.size() : 0);
  for (std::size_t l = 0; l < task.lights.size(); ++l)
  {
    this->fill_light(scene, scene.lights[l], task.lights[l]);
    plain = plain && !scene.lights[l].positional;
  }
  this->fill_fog(scene);
  this->find_deep_enough(scene);
  store4(world_from_index(scene.volumes[0]), task.world_from_index);
  task.absorption = settings.absorption;
  const double voxel = smallest_edge(scene.volumes[0]);
  const Volume& first = scene.volumes[0];
  task.shadows = task.lights.empty() ? ShadowMethod::None : settings.shadows;
  task.by_cells = settings.shadow_step <= 0.0 && has_exact_shadow_rays(scene) &&
    task.shadows == ShadowMethod::Rays;
  task.shadow_step = static_cast<float>(settings.shadow_step > 0.0 ? settings.shadow_step : voxel);

  const bool ambient = lit && (scene.sky.radiance != glm::dvec3(0.0) || scene.sky.ground != glm::dvec3(0.0));
  const bool maps =
    task.shadows == ShadowMethod::Volume || task.shadows == ShadowMethod::Functions;
  const double shrink = // lengths of the world in one of the data
    std::cbrt(std::abs(glm::determinant(glm::dmat3(first.world_from_data))));
  // Where rays find the shadows, the sky's light needs hardly finer nodes than voxels.
  const double spacing = shrink *
    (settings.shadows == ShadowMethod::Rays ? std::clamp(double(task.shadow_step), 0.5 * voxel, voxel)
                                        : double(task.shadow_step));
  const bool sound = spacing > 0.0 && std::isfinite(spacing);
  if (maps && !sound)
  {
    task.shadows = ShadowMethod::None; // the matter is flat
  }
  if ((maps || ambient) && sound)
  {
    std::vector<double> matter;
    for (const Volume& volume : scene.volumes)
    {
      matter.push_back(static_cast<double>(volume.data_revision));
      matter.push_back(static_cast<double>(volume.medium_revision));
      append(matter, world_from_index(volume));
      append(matter, volume.data_from_index);
      const Cropping& c = volume.cropping;
      matter.push_back(c.enabled ? static_cast<double>(c.regions) : -1.0);
      for (int axis = 0; axis < 3 && c.enabled; ++axis)
      {
        matter.push_back(c.lower[axis]);
        matter.push_back(c.upper[axis]);
      }
      for (const glm::dvec4& plane : volume.clipping_planes)
      {
        matter.insert(matter.end(), { plane.x, plane.y, plane.z, plane.w });
      }
      const glm::dvec3 channels = channels_of(volume);
      matter.insert(matter.end(), { channels.x, channels.y, channels.z });
      if (volume.data_revision == 0 || volume.medium_revision == 0)
      {
        this->Maps.clear(); // nothing may be kept
      }
    }
    const bool floats = settings.precise_shadows;
    this->Maps.update(
      scene, volumes, matter, spacing, voxel * shrink, floats, threads, task, ambient, go);
    plain = plain && task.ambient.empty();
  }
  else
  {
    this->Maps.clear();
    task.ambient.clear();
  }
  task.rich = !plain;
  this->Brightest = std::max(this->find_brightest(scene, volumes), this->brightest_fog(scene));
}

}
