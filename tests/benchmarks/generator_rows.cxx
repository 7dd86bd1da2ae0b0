// Volumes made on the spot: noise in packets against one place at a time, clouds dense and sparse.
#include "rows.h"

#include "data-generators/cumulus.h"
#include "data-generators/noise_field.h"
#include "data-generators/sampling.h"
#include "data-generators/sparse_sampling.h"

#include <tbb/global_control.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

namespace benchmarks
{

namespace
{

/// Of all threads of this process.
double processor_seconds()
{
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

double clock_seconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// One thread's processor time for the same places, by value() and by values().
Row noise_row(const Options& options, const char* name, const char* what, brume::NoiseKind kind)
{
  Row row;
  row.name = std::string("noise-") + name;
  row.what = std::string(what) + ", 5 octaves: packets against one place at a time, one thread";
  row.unit = "×";
  row.target = 5.0;
  row.other = "one place at a time";
  row.repetitions = options.quick ? 1 : 5;
  brume::NoiseOptions noise;
  noise.kind = kind;
  auto field = std::make_shared<brume::NoiseField>(noise);
  row.prepare = [](Row&) {};
  row.repeat = [field, quick = options.quick]
  {
    const int n = quick ? 16 : 64;
    const brume::PlaceBlock places{
      glm::dvec3(0.1, 0.2, 0.3), glm::dvec3(8.0 / 256), glm::ivec3(0), glm::ivec3(n)
    };
    std::vector<float> values(places.size());
    Repetition one;
    double start = processor_seconds();
    field->brume::Field::values(places, 0.0, values.data());
    one.other = processor_seconds() - start;
    start = processor_seconds();
    field->values(places, 0.0, values.data());
    one.seconds = processor_seconds() - start;
    one.figure = one.other / one.seconds;
    return one;
  };
  return row;
}

/// So many voxels along each side of the cumulus' box.
brume::Lattice cube_over(const brume::Cumulus& cloud, int size)
{
  const brume::Box box = cloud.bounds();
  brume::Lattice grid;
  grid.dimensions = glm::ivec3(size);
  grid.spacing = (box.upper - box.lower) / double(size);
  grid.origin = box.lower + 0.5 * grid.spacing;
  return grid;
}

Row dense_row(const Options& options)
{
  const int size = options.quick ? 48 : 256;
  Row row;
  row.name = "cloud-dense";
  row.what = "256³ cumulus, 5 octaves and warp, dense, on the clock; other: processor time";
  row.unit = "s";
  row.target = 1.0;
  row.at_least = false;
  row.other = "processor time";
  row.repetitions = options.quick ? 1 : 5;
  row.prepare = [](Row&) {};
  row.repeat = [size, threads = options.threads]
  {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const brume::Cumulus cloud;
    const brume::Lattice grid = cube_over(cloud, size);
    std::vector<float> values(brume::whole_extent(grid).voxels());
    Repetition one;
    const double start = clock_seconds(), processor = processor_seconds();
    brume::sample(cloud, 0.0, grid, brume::whole_extent(grid), values.data());
    one.other = processor_seconds() - processor;
    one.seconds = one.figure = clock_seconds() - start;
    return one;
  };
  return row;
}

Row sparse_row(const Options& options)
{
  const int size = options.quick ? 64 : 1024;
  Row row;
  row.name = "cloud-sparse";
  row.what = "1024³ cumulus, 5 octaves and warp, sparse, on the clock; other: processor time";
  row.unit = "s";
  row.target = 20.0;
  row.at_least = false;
  row.other = "processor time";
  row.prepare = [](Row&) {};
  row.repeat = [size, threads = options.threads]
  {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const brume::Cumulus cloud;
    brume::SparseSampleOptions sparse;
    sparse.threads = threads;
    Repetition one;
    const double start = clock_seconds(), processor = processor_seconds();
    brume::sample_sparse(cloud, 0.0, cube_over(cloud, size), sparse);
    one.other = processor_seconds() - processor;
    one.seconds = one.figure = clock_seconds() - start;
    return one;
  };
  return row;
}

Row sparse_memory_row(const Options& options)
{
  const int size = options.quick ? 64 : 512;
  Row row;
  row.name = "cloud-sparse-memory";
  row.what = "512³ cumulus, sparse, floats of 4 bytes: all that is kept by the active voxels";
  row.unit = "bytes a voxel";
  row.target = 6.0;
  row.at_least = false;
  row.prepare = [](Row&) {};
  row.repeat = [size, threads = options.threads]
  {
    const brume::Cumulus cloud;
    brume::SparseSampleOptions sparse;
    sparse.threads = threads;
    const brume::SparseSample sample =
      brume::sample_sparse(cloud, 0.0, cube_over(cloud, size), sparse);
    Repetition one;
    one.figure = double(sample.voxels->memory_bytes()) / double(sample.active_voxels);
    return one;
  };
  return row;
}

}

void add_generator_rows(Scenes& scenes, std::vector<Row>& rows)
{
  const Options& options = scenes.options();
  rows.push_back(noise_row(options, "perlin", "Perlin noise", brume::NoiseKind::Perlin));
  rows.push_back(noise_row(options, "worley", "Worley noise", brume::NoiseKind::Worley));
  rows.push_back(noise_row(options, "simplex", "simplex noise", brume::NoiseKind::Simplex));
  rows.push_back(
    noise_row(options, "perlin-worley", "Perlin–Worley noise", brume::NoiseKind::PerlinWorley));
  rows.push_back(dense_row(options));
  rows.push_back(sparse_row(options));
  rows.push_back(sparse_memory_row(options));
}

}
