#include "vdb_peer.h"

#include "table.h"

#include "Transport/marcher.h"
#include "Transport/scene.h"

#include "vtkBrumeMedium.h"
#include "vtkBrumeOpenVDBReader.h"
#include "vtkBrumeRayMarchMapper.h"

#include "vtkCamera.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <OpenImageIO/imageio.h>
#include <nlohmann/json.hpp>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>

namespace benchmarks
{

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr double half_height = 1.2; ///< of the parallel view
/// vdb_render's medium: σs = 15/16 of σt.
constexpr double albedo = 0.9375;
const double toward_sun[3] = { 1.0, -0.4, 0.6 };
const double toward_eye[3] = { -0.3, -1.0, 0.2 };

double cloud(double x, double y, double z)
{
  const double r = std::sqrt(x * x + y * y + z * z);
  double bumps = 0.0;
  double amplitude = 0.55;
  double frequency = 5.0;
  for (int octave = 0; octave < 5; ++octave)
  {
    bumps += amplitude * std::sin(1.7 * frequency * x + octave) *
      std::sin(1.9 * frequency * y + 2 * octave) * std::sin(2.3 * frequency * z + 3 * octave);
    amplitude *= 0.6;
    frequency *= 1.9;
  }
  return std::clamp((0.75 - r) * 3.0 + bumps, 0.0, 1.0) * (r < 0.99 ? 1.0 : 0.0);
}

struct Errors
{
  double rms = 0.0;
  double largest = 0.0;
};

Errors errors(const std::vector<float>& a, const std::vector<float>& b)
{
  Errors e;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    const double d = std::abs(double(a[i]) - b[i]);
    e.rms += d * d;
    e.largest = std::max(e.largest, d);
  }
  e.rms = std::sqrt(e.rms / static_cast<double>(a.size()));
  return e;
}

}

SceneOfCloud::SceneOfCloud(int n)
  : image(vtkSmartPointer<vtkImageData>::New())
  , Size(n)
{
  this->image->SetDimensions(n, n, n);
  this->image->SetSpacing(this->voxel(), this->voxel(), this->voxel());
  this->image->AllocateScalars(VTK_FLOAT, 1);
  this->image->GetPointData()->GetScalars()->SetName("density");
  auto* values = static_cast<float*>(this->image->GetScalarPointer());
  const double scale = this->voxel();
  tbb::parallel_for(0, n,
    [&](int k)
    {
      for (int j = 0; j < n; ++j)
      {
        for (int i = 0; i < n; ++i)
        {
          values[(static_cast<std::size_t>(k) * n + j) * n + i] =
            static_cast<float>(cloud(i * scale - 1.0, j * scale - 1.0, k * scale - 1.0));
        }
      }
    });
}

void SceneOfCloud::aim(vtkCamera* camera) const
{
  camera->ParallelProjectionOn();
  camera->SetParallelScale(half_height);
  camera->SetFocalPoint(1.0, 1.0, 1.0);
  camera->SetPosition(
    1.0 + 4.0 * toward_eye[0], 1.0 + 4.0 * toward_eye[1], 1.0 + 4.0 * toward_eye[2]);
  camera->SetViewUp(0.0, 0.0, 1.0);
  camera->SetClippingRange(0.5, 10.0);
}

struct VdbPeer::Parts
{
  std::filesystem::path folder;
  std::string file;
  double extinction = 1.0;
  double voxel = 1.0;
  int resolution = 512;
  int small = 128; ///< pixels of the pictures that are compared
  int threads = 2;
  vtkNew<vtkBrumeOpenVDBReader> reader;
  vtkNew<vtkCamera> camera;
  vtkNew<vtkLightCollection> lights;
  vtkNew<vtkBrumeMedium> medium;
  vtkNew<vtkVolume> volume;

  void write(const SceneOfCloud& scene)
  {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(this->voxel));
    auto accessor = grid->getAccessor();
    const int n = scene.size();
    const auto* values = static_cast<const float*>(scene.image->GetScalarPointer());
    for (int k = 0; k < n; ++k)
    {
      for (int j = 0; j < n; ++j)
      {
        for (int i = 0; i < n; ++i, ++values)
        {
          if (*values > 0.0f)
          {
            accessor.setValue({ i, j, k }, *values);
          }
        }
      }
    }
    openvdb::io::File out(this->file);
    out.setCompression(openvdb::io::COMPRESS_NONE);
    out.write({ grid });
    out.close();
  }

  /// Seconds of a fresh mapper: what it prepares, and the picture.
  double draw(int size, bool exact, brume::Film& film)
  {
    vtkNew<vtkBrumeRayMarchMapper> mapper;
    mapper->SetInputConnection(this->reader->GetOutputPort());
    mapper->SetMedium(this->medium);
    mapper->SetNumberOfThreads(this->threads);
    mapper->AutoAdjustSampleDistancesOff();
    mapper->SetSampleDistance((exact ? 0.125 : 0.5) * this->voxel);
    if (exact)
    {
      mapper->SetTolerance(1e-5);
      mapper->SetShadowMethodToRays();
      mapper->SetShadowSampleDistance(0.125 * this->voxel);
    }
    else
    {
      mapper->SetShadowMethodToVolume();
      mapper->SetShadowSampleDistance(this->voxel);
    }
    this->volume->SetMapper(mapper);
    film = brume::Film(size, size);
    if (!mapper->RenderFilm(this->volume, this->camera, this->lights, film))
    {
      throw std::runtime_error("the cloud could not be drawn");
    }
    const nlohmann::json s = nlohmann::json::parse(mapper->GetStatistics());
    return s["seconds"].get<double>() + s["seconds_prepare"].get<double>();
  }

  double run_peer(int size) const
  {
    const double per_voxel = this->extinction * this->voxel;
    std::ostringstream command;
    command.precision(17);
    // Its steps and coefficients are in voxels; its light has no phase function.
    command << "vdb_render " << this->file << ' ' << (this->folder / "peer.exr").string()
            << " -cpus " << this->threads << " -camera ortho -frame " << 2.0 * half_height
            << " -res " << size << 'x' << size << " -translate " << 1.0 + 4.0 * toward_eye[0]
            << ',' << 1.0 + 4.0 * toward_eye[1] << ',' << 1.0 + 4.0 * toward_eye[2]
            << " -lookat 1,1,1 -up 0,0,1 -absorb " << per_voxel * (1.0 - albedo) << ','
            << per_voxel * (1.0 - albedo) << ',' << per_voxel * (1.0 - albedo) << " -scatter "
            << per_voxel * albedo << ',' << per_voxel * albedo << ',' << per_voxel * albedo
            << " -light " << toward_sun[0] << ',' << toward_sun[1] << ',' << toward_sun[2]
            << ",1,1,1 -gain 0 -step 0.5 -shadowstep 1 > /dev/null 2>&1";
    const auto start = std::chrono::steady_clock::now();
    if (std::system(command.str().c_str()) != 0)
    {
      throw Skipped("vdb_render failed, or is not installed (package libopenvdb-tools)");
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  /// The first channel, rows from the bottom up.
  std::vector<float> read_peer(int size) const
  {
    const auto in = OIIO::ImageInput::open((this->folder / "peer.exr").string());
    if (!in || in->spec().width != size || in->spec().height != size)
    {
      throw std::runtime_error("vdb_render's picture cannot be read");
    }
    const int channels = in->spec().nchannels;
    std::vector<float> all(static_cast<std::size_t>(size) * size * channels);
    in->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, all.data());
    std::vector<float> first;
    for (int y = size - 1; y >= 0; --y)
    {
      for (int x = 0; x < size; ++x)
      {
        first.push_back(all[(static_cast<std::size_t>(y) * size + x) * channels]);
      }
    }
    return first;
  }
};

VdbPeer::VdbPeer(
  const SceneOfCloud& scene, double extinction, int resolution, int threads, bool quick)
  : Own(std::make_unique<Parts>())
{
  Parts& own = *this->Own;
  if (std::system("command -v vdb_render > /dev/null 2>&1") != 0)
  {
    throw Skipped("vdb_render is not installed (package libopenvdb-tools)");
  }
  own.folder =
    std::filesystem::temp_directory_path() / ("brume-peer-" + std::to_string(getpid()));
  std::filesystem::create_directories(own.folder);
  own.file = (own.folder / "cloud.vdb").string();
  own.extinction = extinction;
  own.voxel = scene.voxel();
  own.resolution = resolution;
  own.small = quick ? 32 : 128;
  own.threads = threads;
  own.write(scene);
  own.reader->SetFileName(own.file.c_str());
  own.reader->Update();
  scene.aim(own.camera);
  vtkNew<vtkLight> sun;
  sun->SetLightTypeToSceneLight();
  sun->SetPosition(toward_sun[0], toward_sun[1], toward_sun[2]);
  sun->SetFocalPoint(0.0, 0.0, 0.0);
  sun->SetIntensity(4.0); // times π is the irradiance: 4π · 1/4π is vdb_render's colour of 1
  own.lights->AddItem(sun);
  own.medium->SetExtinction(extinction);
  own.medium->SetAlbedo(albedo, albedo, albedo);
  own.volume->GetProperty()->SetInterpolationTypeToLinear();
}

VdbPeer::~VdbPeer()
{
  std::error_code ignored;
  std::filesystem::remove_all(this->Own->folder, ignored);
}

double VdbPeer::draw()
{
  brume::Film film;
  return this->Own->draw(this->Own->resolution, false, film);
}

double VdbPeer::draw_peer()
{
  // Reading the file is not rendering.
  const double reading = this->Own->run_peer(1);
  return this->Own->run_peer(this->Own->resolution) - reading;
}

std::vector<std::string> VdbPeer::compare()
{
  Parts& own = *this->Own;
  brume::Film film;
  brume::Film truth;
  own.draw(own.small, true, truth);
  own.draw(own.small, false, film);
  own.run_peer(own.small);
  const std::vector<float> theirs = own.read_peer(own.small);
  const Errors a = errors(film.radiance[0], truth.radiance[0]);
  const Errors b = errors(theirs, truth.radiance[0]);
  char text[200];
  std::snprintf(text, sizeof(text),
    "errors against view and shadow rays of 1/8 voxel: Brume rms %.2g, largest %.2g; vdb_render rms "
    "%.2g, largest %.2g",
    a.rms, a.largest, b.rms, b.largest);
  if (!(a.rms < b.rms && a.largest < b.largest))
  {
    throw std::runtime_error(std::string("Brume is not nearer to the truth: ") + text);
  }
  return { text };
}

}
