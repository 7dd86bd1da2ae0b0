// What changes no picture, whatever the scene: tried in random ones.
#include "invariants.h"

#include <glm/ext/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace stability;

namespace
{

const std::string by_rounding =
  "changes no pixel by more than rounding does: 2e-5 of white; where a shadow ray grazes a further "
  "volume or a light volume's node lies on a face, its equal steps are others, for which half of "
  "what halving them changes is allowed";

}

TEST(Invariants, Scale)
{
  HardCase scale("Invariants",
    "scaling space by s and extinction by 1/s, s from 1e-6 to 1e6",
    "any constant with the unit of a length, hidden in an epsilon, shows",
    by_rounding);
  try_unlit_and_lit(scale,
    "scaled space",
    1.0,
    "of rounding",
    [](bool lit, Worst& worst)
    {
      const RandomScene random = draw_scene(lit_or_not(lit));
      const MarchSettings settings = settings_of(random, lit);
      const double s = std::pow(10.0, *rc::gen::inRange(-6, 7));
      Scene scaled = random.scene;
      move_world(scaled, glm::scale(glm::dmat4(1.0), glm::dvec3(s)), s);
      MarchSettings longer = settings;
      longer.step *= s;
      longer.shadow_step *= s;
      RC_ASSERT(
        worst(beyond_rounding(
          random.scene, settings, drawn(random.scene, settings), drawn(scaled, longer))) <= 1.0);
    });
}

TEST(Invariants, Motion)
{
  HardCase motion("Invariants",
    "turning and moving the world with all that is in it",
    "an axis that is not treated like the others shows, and so does a place that is not relative",
    by_rounding);
  try_unlit_and_lit(motion,
    "moved world",
    1.0,
    "of rounding",
    [](bool lit, Worst& worst)
    {
      const RandomScene random = draw_scene(lit_or_not(lit));
      const MarchSettings settings = settings_of(random, lit);
      const glm::dvec3 axis(
        *rc::gen::inRange(1, 9), *rc::gen::inRange(-8, 9), *rc::gen::inRange(-8, 9));
      const double angle = *rc::gen::inRange(0, 628) * 0.01;
      const double away = *rc::gen::element(0.0, 1.0, 1e3, 1e5) * random.view.half_height;
      Scene moved = random.scene;
      move_world(moved,
        glm::rotate(glm::translate(glm::dmat4(1.0), glm::normalize(axis) * away),
          angle,
          glm::normalize(axis)),
        1.0);
      RC_ASSERT(
        worst(beyond_rounding(
          random.scene, settings, drawn(random.scene, settings), drawn(moved, settings))) <= 1.0);
    });
}

namespace
{

/// The same matter, its axes in the order y, z, x.
RandomScene turned_axes(const RandomScene& random)
{
  RandomScene turned = random;
  turned.voxels.clear();
  for (Volume& volume : turned.scene.volumes)
  {
    const Grid old = volume.grid;
    const float* from = static_cast<const float*>(old.voxels);
    auto values = std::make_shared<std::vector<float>>(old.voxel_count());
    const int n[3] = { old.dims[1], old.dims[2], old.dims[0] };
    for (int k = 0; k < n[2]; ++k)
    {
      for (int j = 0; j < n[1]; ++j)
      {
        for (int i = 0; i < n[0]; ++i)
        {
          (*values)[(static_cast<std::size_t>(k) * n[1] + j) * n[0] + i] =
            from[(static_cast<std::size_t>(j) * old.dims[1] + i) * old.dims[0] + k];
        }
      }
    }
    std::copy(n, n + 3, volume.grid.dims);
    volume.grid.voxels = values->data();
    turned.voxels.push_back(values);
    const glm::dmat4 m = volume.data_from_index;
    volume.data_from_index[0] = m[1];
    volume.data_from_index[1] = m[2];
    volume.data_from_index[2] = m[0];
  }
  return turned;
}

}

TEST(Invariants, Axes)
{
  HardCase axes("Invariants",
    "the grid's axes in another order, the same matter in the same place",
    "x is read by pairs, bricks and tables go by rows: an index that is taken for another shows",
    by_rounding);
  try_unlit_and_lit(axes,
    "turned axes",
    1.0,
    "of rounding",
    [](bool lit, Worst& worst)
    {
      const RandomScene random = draw_scene(lit_or_not(lit));
      MarchSettings settings = settings_of(random, lit);
      // Lattices follow the grid's axes.
      settings.shadows = lit ? ShadowMethod::Rays : ShadowMethod::None;
      RC_ASSERT(worst(beyond_rounding(random.scene,
                  settings,
                  drawn(random.scene, settings),
                  drawn(turned_axes(random).scene, settings))) <= 1.0);
    });
}

TEST(Invariants, EmptyVolume)
{
  HardCase empty("Invariants",
    "an empty volume more",
    "other kernels draw it, rays are cut where it begins and ends, and its colour or its 0/0 could "
    "leak",
    "in the same box: no pixel changes by more than rounding does (2e-5 of white); in any other "
    "box the truth does not change by more than its tolerance of 1e-4, or by what it says was "
    "still changing where that is more");
  Worst worst_truth;
  try_unlit_and_lit(empty,
    "an empty volume more",
    1.0,
    "of rounding",
    [&worst_truth](bool lit, Worst& worst)
    {
      SceneWishes wishes = lit_or_not(lit);
      wishes.volumes = 1;
      const RandomScene random = draw_scene(wishes);
      Scene more = random.scene;
      more.volumes.push_back(more.volumes[0]);
      Volume& added = more.volumes.back();
      std::vector<float> nothing(added.grid.voxel_count(), 0.0f);
      const int kind = *rc::gen::inRange(0, 4);
      if (kind == 0)
      {
        added.weight = 0.0;
      }
      else if (added.meaning == ValueMeaning::Density)
      {
        kind == 1 ? static_cast<void>(added.density.extinction = 0.0)
                  : static_cast<void>(added.grid.voxels = nothing.data());
      }
      else
      {
        std::fill(added.classification.opacity.begin(), added.classification.opacity.end(), 0.0);
      }
      if (kind == 3)
      {
        std::swap(more.volumes[0], more.volumes[1]);
      }
      MarchSettings settings = settings_of(random, lit);
      // Shadow rays of one trilinear density go cell by cell, those of two by steps: the same
      // steps.
      settings.shadows = lit ? ShadowMethod::None : settings.shadows;
      RC_ASSERT(
        worst(beyond_rounding(
          random.scene, settings, drawn(random.scene, settings), drawn(more, settings))) <= 1.0);
      if (lit || kind == 3)
      {
        return;
      }
      added.data_from_index =
        glm::translate(glm::dmat4(1.0), glm::dvec3(0.3, -0.2, 0.4) * random.view.half_height) *
        added.data_from_index;
      const Film truth = by_reference(random.scene, 1e-4);
      const Film other = by_reference(more, 1e-4);
      RC_ASSERT(
        worst_truth(relative(truth, other) / std::max(1e-4, unsettled(truth, other))) <= 1.0);
    });
  empty.measure(worst_truth.value, 1.0, "of the truth's tolerance", "reference");
}

namespace
{

/// The first volume cut in two at a plane of voxels, which both have.
RandomScene split(const RandomScene& random, int plane)
{
  RandomScene result = random;
  const Volume whole = random.scene.volumes[0];
  const int* n = whole.grid.dims;
  const float* from = static_cast<const float*>(whole.grid.voxels);
  result.scene.volumes.clear();
  for (const int part : { 0, 1 })
  {
    const int first = part == 0 ? 0 : plane;
    const int last = part == 0 ? plane : n[0] - 1;
    auto values = std::make_shared<std::vector<float>>();
    for (int row = 0; row < n[1] * n[2]; ++row)
    {
      values->insert(values->end(), from + row * n[0] + first, from + row * n[0] + last + 1);
    }
    Volume half = whole;
    half.grid.voxels = values->data();
    half.grid.dims[0] = last - first + 1;
    half.data_from_index = glm::translate(whole.data_from_index, glm::dvec3(first, 0.0, 0.0));
    result.voxels.push_back(values);
    result.scene.volumes.push_back(half);
  }
  return result;
}

}

TEST(Invariants, SplitVolume)
{
  HardCase halves("Invariants",
    "a volume split in two at a plane of voxels",
    "a ray leaves one box where it enters the other: what lies in neither is a seam, what lies in "
    "both is drawn twice",
    "the truth changes by no more than its tolerance of 1e-4, or by what it says was still "
    "changing; the march by no more than steps a quarter as long change it, five times, and 1e-4; "
    "so "
    "does light by shadow rays. The sky's is left out: it lies on a lattice that both boxes share, "
    "half a voxel apart at the least, and has that lattice's error");
  Worst worst_truth;
  try_unlit_and_lit(halves,
    "split volumes",
    1.0,
    "of what steps allow",
    [&worst_truth](bool lit, Worst& worst)
    {
      SceneWishes wishes = lit_or_not(lit);
      wishes.volumes = 1;
      wishes.sky = false;
      RandomScene random = draw_scene(wishes);
      Volume& volume = random.scene.volumes[0];
      volume.grid.cell_centred = false;
      RC_PRE(volume.grid.dims[0] >= 3);
      const RandomScene two = split(random, *rc::gen::inRange(1, volume.grid.dims[0] - 1));
      MarchSettings settings = settings_of(random, lit);
      settings.shadows = ShadowMethod::Rays;
      settings.shadow_step = 0.5 * settings.step;
      settings.step *= 0.5;
      const Film film = drawn(random.scene, settings);
      const Film other = drawn(two.scene, settings);
      // Half of them are as long as before where a ray cuts a corner shorter than that.
      settings.step *= 0.25;
      settings.shadow_step *= 0.25;
      const double changed = std::max(
        relative(film, drawn(random.scene, settings)), relative(other, drawn(two.scene, settings)));
      RC_ASSERT(worst(relative(film, other) / (5.0 * changed + 1e-4)) <= 1.0);
      if (!lit)
      {
        const Film truth = by_reference(random.scene, 1e-4);
        const Film of_two = by_reference(two.scene, 1e-4);
        RC_ASSERT(
          worst_truth(relative(truth, of_two) / std::max(1e-4, unsettled(truth, of_two))) <= 1.0);
      }
    });
  halves.measure(worst_truth.value, 1.0, "of the truth's tolerance", "reference");
}

TEST(Invariants, Truth)
{
  HardCase truth("Invariants",
    "the march, step halved after step, and the truth",
    "they share no arithmetic: transfer functions of two nodes and of 257, colours, boxes that "
    "overlap; what converges to something else has another idea of the optics",
    "where two halvings in a row changed no pixel by more than 1e-3, they differ by 2e-3 at most, "
    "or by what the truth says was still changing");
  Worst worst;
  int settled = 0;
  const int held = try_scenes("march and truth",
    [&]()
    {
      const RandomScene random = draw_scene(lit_or_not(false));
      MarchSettings settings = settings_of(random, false);
      settings.step *= 0.5;
      Film film = drawn(random.scene, settings);
      int calm = 0;
      for (int halvings = 0; calm < 2 && halvings < 9; ++halvings)
      {
        settings.step *= 0.5;
        Film finer = drawn(random.scene, settings);
        calm = relative(finer, film) <= 1e-3 ? calm + 1 : 0;
        film = std::move(finer);
      }
      if (calm == 2)
      {
        ++settled;
        const Film exact = by_reference(random.scene, 1e-4);
        RC_ASSERT(worst(relative(film, exact) / std::max(2e-3, unsettled(exact, exact))) <= 1.0);
      }
    });
  tell(truth, held, worst, 1.0, "of what both allow", "march, reference");
  truth.holds(20 * settled >= 19 * property_trials(few), "19 of 20 settle", "march");
}

TEST(Invariants, Transmittance)
{
  HardCase product("Invariants",
    "the transmittance of a way is that of its parts, multiplied",
    "parts begin and end anywhere in steps and cells, of optical depths from 1e-6 to far beyond "
    "what passes",
    "T = T₁ · T₂ within rounding (2e-5 of white) for densities cell by cell; within 2e-4 for the "
    "truth's three pictures, each of a tolerance of 1e-4");
  Worst worst;
  Worst worst_truth;
  const int held = try_scenes("transmittance is multiplicative",
    [&]()
    {
      SceneWishes wishes;
      const bool exact = *rc::gen::arbitrary<bool>();
      wishes.classified = !exact;
      RandomScene random = draw_scene(wishes);
      random.scene.volumes[0].density.channels = glm::dvec3(1.0); // coloured, it would go by steps
      const double part = *rc::gen::inRange(1, 1000) * 1e-3;
      const auto between = [&](double from, double to)
      {
        View view = random.view;
        const double length = view.far_plane - view.near_plane;
        view.far_plane = view.near_plane + to * length;
        view.near_plane = view.near_plane + from * length;
        Scene scene = random.scene;
        scene.camera = view.camera(1.0);
        if (!exact)
        {
          return by_reference(scene, 1e-4);
        }
        MarchSettings settings = settings_of(random, false);
        settings.rule = StepRule::Cells;
        return drawn(scene, settings);
      };
      const Film whole = between(0.0, 1.0);
      const Film first = between(0.0, part);
      const Film second = between(part, 1.0);
      double most = 0.0;
      for (int c = 0; c < 3; ++c)
      {
        for (std::size_t i = 0; i < whole.size(); ++i)
        {
          const double off =
            std::abs(double(whole.transmittance[c][i]) -
                     double(first.transmittance[c][i]) * second.transmittance[c][i]);
          most = off <= most ? most : off;
        }
      }
      const bool holds = exact ? worst(most / rounding) <= 1.0 : worst_truth(most) <= 2e-4;
      RC_ASSERT(holds);
    });
  tell(product, held, worst, 1.0, "of rounding", "cells");
  product.measure(worst_truth.value, 2e-4, "of white, of the truth", "reference");
}
