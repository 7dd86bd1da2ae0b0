#include "random_scene.h"

#include <rapidcheck.h>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <random>

namespace stability
{

namespace
{

/// RapidCheck's numbers shrink to the lower end.
double fraction()
{
  return *rc::gen::inRange(0, 1000001) * 1e-6;
}
double between(double lower, double upper)
{
  return lower + (upper - lower) * fraction();
}
bool coin()
{
  return *rc::gen::arbitrary<bool>();
}
glm::dvec3 direction()
{
  const double z = between(-1.0, 1.0);
  const double turn = between(0.0, 6.283185307179586);
  const double r = std::sqrt(std::max(1.0 - z * z, 0.0));
  return { r * std::cos(turn), r * std::sin(turn), z };
}
glm::dvec3 colour()
{
  return { fraction(), fraction(), fraction() };
}

/// Voxels of one of some kinds: even, ramps, noise, sparse noise, a step.
std::shared_ptr<std::vector<float>> draw_voxels(const glm::ivec3& dims)
{
  auto values =
    std::make_shared<std::vector<float>>(static_cast<std::size_t>(dims.x) * dims.y * dims.z);
  const int kind = *rc::gen::inRange(0, 5);
  std::mt19937 random(*rc::gen::inRange(0, 1 << 30));
  std::uniform_real_distribution<float> any(0.0f, 1.0f);
  const int edge = *rc::gen::inRange(0, dims.x);
  std::size_t at = 0;
  for (int k = 0; k < dims.z; ++k)
  {
    for (int j = 0; j < dims.y; ++j)
    {
      for (int i = 0; i < dims.x; ++i, ++at)
      {
        const float noise = any(random);
        (*values)[at] = kind == 0   ? 1.0f
                        : kind == 1 ? 0.1f + 0.9f * i / dims.x
                        : kind == 2 ? noise
                        : kind == 3 ? (noise > 0.9f ? noise : 0.0f)
                                    : (i >= edge ? 1.0f : 0.0f);
      }
    }
  }
  return values;
}

glm::dmat4 draw_matrix(const glm::ivec3& dims, bool awkward, double& voxel)
{
  glm::dmat4 m(1.0);
  voxel = awkward ? std::pow(10.0, *rc::gen::inRange(-6, 7)) : 1.0;
  glm::dvec3 spacing(voxel);
  if (awkward && coin())
  {
    spacing[*rc::gen::inRange(0, 3)] *= std::pow(10.0, *rc::gen::inRange(-3, 4) * 0.5);
  }
  glm::dvec3 origin(0.0);
  if (awkward)
  {
    const double away = *rc::gen::element(0.0, 1.0, 1e3, 1e5);
    origin = direction() * away * voxel * static_cast<double>(dims.x);
  }
  m = placed(spacing, origin);
  if (awkward && coin())
  {
    m = glm::rotate(m, between(0.0, 6.28), direction());
    glm::dmat4 shear(1.0);
    shear[1][0] = between(0.0, 0.5);
    shear[2][1] = between(0.0, 0.5);
    shear[0][0] = coin() ? -1.0 : 1.0;
    m = m * shear;
  }
  return m;
}

/// The mean length of the columns.
double edge_of(const glm::dmat4& m)
{
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    sum += glm::length(glm::dvec3(m[axis]));
  }
  return sum / 3.0;
}

void draw_meaning(const SceneWishes& wishes, double edge, int longest, Volume& volume)
{
  const bool density = !wishes.classified || (wishes.density && coin());
  // From hardly anything to nothing passes.
  const double depth = *rc::gen::element(1e-6, 1e-2, 0.3, 1.0, 4.0, 30.0);
  if (density)
  {
    volume.meaning = ValueMeaning::Density;
    volume.density.extinction = depth / (edge * longest);
    if (coin())
    {
      volume.density.channels = { 1.0, fraction(), fraction() };
    }
    return;
  }
  volume.meaning = ValueMeaning::Classified;
  Classification& c = volume.classification;
  const int nodes = *rc::gen::element(2, 3, 17, 257);
  for (int i = 0; i < nodes; ++i)
  {
    c.opacity.push_back(0.9 * fraction());
    const glm::dvec3 rgb = colour();
    c.rgb.insert(c.rgb.end(), { rgb.x, rgb.y, rgb.z });
  }
  if (coin())
  {
    c.opacity.front() = 0.0; // something to leap over
  }
  c.unit_distance = edge * longest / depth;
}

void draw_medium(Medium& medium)
{
  medium.lit = true;
  medium.albedo = colour();
  const int lobes = *rc::gen::inRange(0, 3);
  for (int i = 0; i < lobes; ++i)
  {
    PhaseLobe lobe;
    lobe.function = *rc::gen::element(PhaseFunction::Isotropic,
      PhaseFunction::Rayleigh,
      PhaseFunction::HenyeyGreenstein,
      PhaseFunction::Schlick);
    lobe.weight = between(0.1, 1.0);
    lobe.anisotropy = between(-0.9, 0.9);
    medium.lobes.push_back(lobe);
  }
}

}

void draw_target()
{
  static const std::vector<std::string> all = targets();
  force_simd_target(*rc::gen::elementOf(all));
}

RandomScene draw_scene(const SceneWishes& wishes)
{
  RandomScene result;
  const int count = wishes.volumes > 1 ? *rc::gen::inRange(1, wishes.volumes + 1) : 1;
  result.scene.volumes.resize(count);
  glm::dvec3 middle(0.0);
  for (int v = 0; v < count; ++v)
  {
    Volume& volume = result.scene.volumes[v];
    const glm::ivec3 dims(
      *rc::gen::inRange(2, 20), *rc::gen::inRange(2, 12), *rc::gen::inRange(2, 12));
    result.voxels.push_back(draw_voxels(dims));
    volume.grid.voxels = result.voxels.back()->data();
    volume.grid.type = VoxelType::Float32;
    volume.grid.cell_centred = coin();
    for (int axis = 0; axis < 3; ++axis)
    {
      volume.grid.dims[axis] = dims[axis];
    }
    double voxel = 1.0;
    if (v == 0)
    {
      volume.data_from_index = draw_matrix(dims, wishes.awkward, voxel);
      result.voxel = voxel;
      middle = glm::dvec3(volume.data_from_index * glm::dvec4(0.5 * glm::dvec3(dims - 1), 1.0));
    }
    else
    {
      // Others overlap the first.
      const glm::dvec3 corner = middle + direction() * (0.5 * result.voxel * dims.x) -
                                0.5 * result.voxel * glm::dvec3(dims - 1);
      volume.data_from_index = placed(glm::dvec3(result.voxel * between(0.5, 1.5)), corner);
    }
    const double edge = edge_of(volume.data_from_index);
    draw_meaning(wishes, edge, std::max({ dims.x, dims.y, dims.z }), volume);
    if (wishes.lit)
    {
      draw_medium(volume.medium);
    }
  }
  if (wishes.lit)
  {
    const int lights = *rc::gen::inRange(1, 4);
    for (int i = 0; i < lights; ++i)
    {
      Light light;
      light.diffuse = colour() * 2.0;
      light.direction = direction();
      if (wishes.lamps && coin())
      {
        light.positional = true;
        // Outside: in matter a lamp's light has no bound.
        const double extent = 20.0 * edge_of(result.scene.volumes[0].data_from_index);
        light.position = middle - direction() * 2.0 * extent;
        light.attenuation = { 1.0, 0.0, between(0.0, 1.0) / (extent * extent) };
      }
      result.scene.lights.push_back(light);
    }
    if (wishes.sky && coin())
    {
      result.scene.sky.radiance = colour();
      result.scene.sky.ground = colour();
      result.scene.sky.up = direction();
    }
  }
  result.view = view_of(result.scene, direction(), wishes.parallel_only || coin());
  result.scene.camera = result.view.camera(1.0);
  return result;
}

}
