#include "step_key.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstddef>

namespace brume
{

namespace
{

void add(std::vector<double>& key, const glm::dvec3& v)
{
  key.insert(key.end(), { v.x, v.y, v.z });
}

void add(std::vector<double>& key, const std::vector<PhaseLobe>& lobes)
{
  key.push_back(static_cast<double>(lobes.size()));
  for (const PhaseLobe& lobe : lobes)
  {
    key.insert(key.end(), { static_cast<double>(lobe.function), lobe.weight, lobe.anisotropy });
  }
}

void add(std::vector<double>& key, const Medium& medium)
{
  key.push_back(medium.lit);
  if (!medium.lit)
  {
    return;
  }
  add(key, medium.albedo);
  add(key, medium.lobes);
  add(key, medium.emission);
  const Octaves& octaves = medium.octaves;
  const SilverLining& lining = medium.silver_lining;
  const Powder& powder = medium.powder;
  key.insert(key.end(),
    { static_cast<double>(octaves.count),
      octaves.attenuation,
      octaves.contribution,
      octaves.anisotropy,
      medium.black_body,
      medium.black_body_reference,
      medium.temperature_scale,
      static_cast<double>(lining.enabled),
      lining.strength,
      lining.spread,
      lining.back,
      static_cast<double>(powder.enabled),
      powder.strength,
      static_cast<double>(powder.form),
      powder.scale });
}

/// Along the picture's axes and into it, whatever the near and the far plane.
glm::dvec3 seen_by(const Camera& camera, const glm::dvec4& place)
{
  const glm::dvec4 clip = camera.clip_from_world * place;
  return { clip.x, clip.y, clip.w };
}

bool same(const glm::dvec3& a, const glm::dvec3& b)
{
  return glm::length(a - b) <= 1e-6 * std::max(glm::length(a), glm::length(b));
}

}

bool is_lit(const Scene& scene)
{
  return scene.fog.enabled || std::any_of(scene.volumes.begin(),
                                scene.volumes.end(),
                                [](const Volume& volume) { return volume.medium.lit; });
}

std::vector<double> SceneKey::NumbersOf(const Scene& scene, const std::vector<double>& more)
{
  std::vector<double> key = more;
  key.push_back(static_cast<double>(scene.blend_mode));
  for (const Volume& volume : scene.volumes)
  {
    key.push_back(static_cast<double>(volume.data_revision));
    key.push_back(static_cast<double>(volume.medium_revision));
    key.push_back(volume.shading.enabled);
    add(key, volume.medium);
  }
  if (scene.blend_mode == BlendMode::Isosurface)
  {
    key.insert(key.end(), scene.isosurfaces.begin(), scene.isosurfaces.end());
  }
  if (!is_lit(scene))
  {
    return key;
  }
  add(key, scene.sky.radiance);
  add(key, scene.sky.ground);
  add(key, scene.sky.up);
  key.push_back(scene.fog.enabled);
  if (scene.fog.enabled)
  {
    add(key, scene.fog.extinction);
    add(key, scene.fog.albedo);
    add(key, scene.fog.lobes);
    key.insert(key.end(), { scene.fog.falloff, scene.fog.base_height });
  }
  for (const Light& light : scene.lights)
  {
    add(key, light.diffuse);
    add(key, light.specular);
    add(key, light.attenuation);
    key.insert(
      key.end(), { static_cast<double>(light.positional), light.cone_angle, light.exponent });
  }
  return key;
}

std::vector<SceneKey::Place> SceneKey::PlacesOf(const Scene& scene)
{
  std::vector<Place> places;
  if (is_lit(scene))
  {
    for (const Light& light : scene.lights)
    {
      const glm::dvec3 position = light.positional ? light.position : glm::dvec3(0.0);
      const glm::dvec4 point(position, light.positional ? 1.0 : 0.0);
      places.push_back({ { position, light.direction },
        { seen_by(scene.camera, point),
          seen_by(scene.camera, glm::dvec4(light.direction, 0.0)) } });
    }
  }
  return places;
}

bool SceneKey::Holds(const Scene& scene, const std::vector<double>& more) const
{
  if (this->Numbers.empty() || this->Numbers != NumbersOf(scene, more))
  {
    return false;
  }
  // As many lights as before, or none that count: their colours were among the numbers.
  const std::vector<Place> places = PlacesOf(scene);
  for (std::size_t i = 0; i < this->Places.size(); ++i)
  {
    const Place& now = places[i];
    const Place& then = this->Places[i];
    const bool stays = same(now.world[0], then.world[0]) && same(now.world[1], then.world[1]);
    const bool follows = same(now.seen[0], then.seen[0]) && same(now.seen[1], then.seen[1]);
    if (!stays && !follows)
    {
      return false;
    }
  }
  return true;
}

void SceneKey::Take(const Scene& scene, const std::vector<double>& more, bool places)
{
  this->Numbers = NumbersOf(scene, more);
  this->Places = places ? PlacesOf(scene) : std::vector<Place>();
}

void SceneKey::Clear()
{
  this->Numbers.clear();
  this->Places.clear();
}

}
