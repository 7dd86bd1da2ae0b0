#include "volume_scene.h"

#include "command.h"
#include "interruption.h"
#include "mesh_scene.h"
#include "option_checks.h"
#include "presets.h"

#include "Transport/bricks.h"
#include "Transport/lookup_table.h"
#include "Transport/scene.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSmartVolumeMapper.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkMath.h"
#include "vtkAbstractVolumeMapper.h"
#include "vtkBoundingBox.h"
#include "vtkColorTransferFunction.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <sstream>
#include <type_traits>
#include <utility>

namespace brume::app
{

namespace
{

/// How much of the picture the volume's box may fill when the camera is placed by itself.
constexpr double fill = 0.96;

double largest(const Triple& v)
{
  return std::max({ v[0], v[1], v[2] });
}

/// The volume as Transport sees it, by a mapper that draws nothing.
class PlainScene
{
public:
  /// Throws Failure for a volume that cannot be drawn.
  explicit PlainScene(const VolumeScene& scene)
    : Volume(scene.volume)
    , Former(scene.volume->GetMapper())
  {
    this->Mapper->SetInputDataObject(scene.input.data());
    this->Mapper->SetExtinction(largest(scene.options.extinction));
    apply(scene.options.modes, this->Mapper, scene.volume->GetProperty());
    scene.volume->SetMapper(this->Mapper);
    std::string error;
    vtkNew<vtkCallbackCommand> observer; // in place of the standard error stream
    observer->SetClientData(&error);
    observer->SetCallback([](vtkObject*, unsigned long, void* data, void* text)
      { *static_cast<std::string*>(data) = static_cast<const char*>(text); });
    const unsigned long tag = this->Mapper->AddObserver(vtkCommand::ErrorEvent, observer);
    vtkNew<vtkCamera> camera;
    this->Plain =
      this->Mapper->UpdateScene(scene.volume, camera, scene.lights, scene.width(), scene.height());
    this->Mapper->RemoveObserver(tag);
    if (!this->Plain)
    {
      this->Volume->SetMapper(this->Former);
      throw Failure(scene.options.input + ": " +
        (error.empty() ? "it cannot be drawn: see brume info" : words_of_vtk(error)));
    }
  }
  ~PlainScene() { this->Volume->SetMapper(this->Former); }
  PlainScene(const PlainScene&) = delete;
  PlainScene& operator=(const PlainScene&) = delete;

  const brume::Scene* scene() const { return this->Plain; }

private:
  vtkVolume* Volume;
  vtkSmartPointer<vtkAbstractVolumeMapper> Former;
  vtkNew<vtkBrumeRayMarchMapper> Mapper;
  const brume::Scene* Plain = nullptr;
};

/// The corners, in the world, of each brick of the volume that can be seen with its transfer
/// functions; of the whole volume where none can.
std::vector<glm::dvec3> visible_corners_of_volume(const VolumeScene& scene)
{
  const PlainScene made(scene);
  const brume::Scene* const plain = made.scene();
  const BrickRanges& ranges = *plain->volumes[0].ranges;
  LookupTable table;
  const bool density = plain->volumes[0].meaning == ValueMeaning::Density;
  if (!density)
  {
    table = make_lookup_table(plain->volumes[0].classification);
  }
  const VisibleBricks bricks = find_visible_bricks(
    ranges,
    [&](float lower, float upper) { return density ? upper > 0.0f : table.can_show(lower, upper); },
    table.empty_value);
  std::vector<glm::dvec3> corners;
  const auto add_box = [&](const glm::dvec3& lower, const glm::dvec3& upper)
  {
    for (int corner = 0; corner < 8; ++corner)
    {
      glm::dvec4 place(lower, 1.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        place[axis] = (corner >> axis) & 1 ? upper[axis] : lower[axis];
      }
      corners.push_back(glm::dvec3(plain->volumes[0].data_from_index * place));
    }
  };
  const Grid& grid = plain->volumes[0].grid;
  const glm::dvec3 begin(grid.first[0], grid.first[1], grid.first[2]);
  const glm::dvec3 last(grid.upper(0), grid.upper(1), grid.upper(2));
  std::size_t index = 0;
  for (int z = 0; z < bricks.dims[2]; ++z)
  {
    for (int y = 0; y < bricks.dims[1]; ++y)
    {
      for (int x = 0; x < bricks.dims[0]; ++x, ++index)
      {
        if (bricks.distance[index] == 0)
        {
          const glm::dvec3 lower = double(ranges.edge()) * glm::dvec3(x, y, z);
          add_box(glm::max(lower, begin), glm::min(lower + double(ranges.edge()), last));
        }
      }
    }
  }
  if (corners.empty())
  {
    add_box(begin, last);
  }
  return corners;
}

/// The same, and those of the meshes' boxes.
std::vector<glm::dvec3> visible_corners(VolumeScene& scene)
{
  std::vector<glm::dvec3> corners;
  if (scene.volume)
  {
    corners = visible_corners_of_volume(scene);
  }
  for (vtkPolyData* mesh : scene.meshes)
  {
    vtkBoundingBox box(mesh->GetBounds());
    for (int i = 0; i < 8; ++i)
    {
      glm::dvec3 corner;
      box.GetCorner(i, &corner.x);
      corners.push_back(corner);
    }
  }
  return corners;
}

/// Makes the named array the image's scalars.
void choose_array(Input& input, const std::string& name, const std::string& input_name)
{
  if (name.empty())
  {
    return;
  }
  if (!input.image)
  {
    throw Failure("--density-array " + name, input_name + " is sparse, and has no arrays to choose from",
      "leave it out, or choose a --grid", BadCall);
  }
  vtkPointData* data = input.image->GetPointData();
  if (data->SetActiveScalars(name.c_str()) < 0)
  {
    std::vector<std::string> names;
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    {
      names.emplace_back(data->GetArrayName(i) ? data->GetArrayName(i) : "(without a name)");
    }
    throw Failure("--density-array " + name, input_name + " has no such array of points",
      "choose among " + listed(names), BadCall);
  }
}

glm::dvec3 to_glm(const double v[3])
{
  return { v[0], v[1], v[2] };
}

void check_view_up(const glm::dvec3& view_up, const glm::dvec3& line_of_sight)
{
  if (!(glm::length(glm::cross(view_up, line_of_sight)) > 1e-6 * glm::length(view_up)))
  {
    throw Failure("--camera-view-up", "up is along the line of sight",
      "give another direction, such as 0,1,0", BadCall);
  }
}

/// Places the camera so that all points are within the picture, their box in its middle.
void fit_camera(const std::vector<glm::dvec3>& points, vtkCamera* camera, double aspect,
  glm::dvec3 toward_eye, const glm::dvec3& view_up)
{
  toward_eye = glm::normalize(toward_eye);
  check_view_up(view_up, toward_eye);
  const glm::dvec3 right = glm::normalize(glm::cross(view_up, toward_eye));
  const glm::dvec3 up = glm::cross(toward_eye, right);
  const glm::dmat3 world_from_view(right, up, toward_eye);
  glm::dvec3 lower(VTK_DOUBLE_MAX);
  glm::dvec3 upper(-VTK_DOUBLE_MAX);
  for (const glm::dvec3& point : points)
  {
    const glm::dvec3 view = point * world_from_view;
    lower = glm::min(lower, view);
    upper = glm::max(upper, view);
  }
  const glm::dvec3 centre = 0.5 * (lower + upper);
  const double tangent =
    std::tan(vtkMath::RadiansFromDegrees(0.5 * camera->GetViewAngle())) * fill;
  double distance = 0.0;
  for (const glm::dvec3& point : points)
  {
    const glm::dvec3 view = point * world_from_view - centre;
    const double half = std::max(std::abs(view.y), std::abs(view.x) / aspect);
    distance = std::max(distance, view.z + half / tangent);
  }
  // A single point has no size that tells how far to go back.
  distance = std::max(distance, 1e-6 * (1.0 + glm::length(centre)));
  const glm::dvec3 focal = world_from_view * centre;
  const glm::dvec3 position = focal + toward_eye * distance;
  camera->SetFocalPoint(focal.x, focal.y, focal.z);
  camera->SetPosition(position.x, position.y, position.z);
  camera->SetViewUp(view_up.x, view_up.y, view_up.z);
}

vtkSmartPointer<vtkCamera> make_camera(VolumeScene& scene)
{
  const SceneOptions& options = scene.options;
  auto camera = vtkSmartPointer<vtkCamera>::New();
  camera->SetViewAngle(options.camera_view_angle);
  const double aspect = double(options.resolution[0]) / options.resolution[1];
  const glm::dvec3 patient(-0.45, 0.85, 0.25);
  const glm::dvec3 thing(0.45, -0.85, 0.25);
  const std::array<double, 3> up = options.camera_view_up.value_or(std::array<double, 3>{ 0, 0, 1 });
  fit_camera(visible_corners(scene), camera, aspect,
    scene.input.patient_axes ? patient : thing, glm::dvec3(up[0], up[1], up[2]));
  if (options.camera_focal_point)
  {
    camera->SetFocalPoint(options.camera_focal_point->data());
  }
  if (options.camera_position)
  {
    camera->SetPosition(options.camera_position->data());
  }
  if (camera->GetDistance() <= 0.0 ||
    vtkMath::Distance2BetweenPoints(camera->GetPosition(), camera->GetFocalPoint()) == 0.0)
  {
    throw Failure("--camera-position", "the eye is at the focal point",
      "move one of them: --camera-focal-point", BadCall);
  }
  check_view_up(glm::dvec3(up[0], up[1], up[2]), to_glm(camera->GetDirectionOfProjection()));
  if (options.camera_parallel_scale)
  {
    camera->ParallelProjectionOn();
    camera->SetParallelScale(*options.camera_parallel_scale);
  }
  return camera;
}

/// A step so short that a ray would not end in any patience is refused.
void check_sample_distance(const VolumeScene& scene)
{
  constexpr double most_steps = 1 << 20;
  const std::array<double, 6> bounds = scene.bounds();
  const double diagonal = glm::length(
    glm::dvec3(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]));
  const double least = diagonal / most_steps;
  if (scene.options.sample_distance && *scene.options.sample_distance < least)
  {
    std::ostringstream remedy;
    remedy << "give at least " << least;
    throw Failure("--sample-distance", "a ray would take more than a million steps through " +
        scene.options.input, remedy.str(), BadCall);
  }
}

double smallest_edge(const Input& input)
{
  double spacing[3];
  input.sparse ? input.sparse->GetSpacing(spacing) : input.image->GetSpacing(spacing);
  return std::min({ std::abs(spacing[0]), std::abs(spacing[1]), std::abs(spacing[2]) });
}

/// The volume's property: the preset, and what the options have in its place.
void give_property(VolumeScene& scene)
{
  const SceneOptions& options = scene.options;
  vtkNew<vtkVolumeProperty> property;
  if (scene.preset)
  {
    apply(*scene.preset, scene.input.data(), property);
  }
  vtkNew<vtkColorTransferFunction> colour;
  for (const ColourPoint& p : options.colour)
  {
    colour->AddRGBPoint(p.value, p.red, p.green, p.blue);
  }
  vtkNew<vtkPiecewiseFunction> opacity;
  for (const OpacityPoint& p : options.opacity)
  {
    opacity->AddPoint(p.value, p.opacity);
  }
  for (int c = 0; c < VTK_MAX_VRCOMP; ++c)
  {
    if (!options.colour.empty())
    {
      property->SetColor(c, colour);
    }
    if (!options.opacity.empty())
    {
      property->SetScalarOpacity(c, opacity);
    }
    if (options.opacity_unit_distance)
    {
      property->SetScalarOpacityUnitDistance(c, *options.opacity_unit_distance);
    }
    if (options.shade != "preset")
    {
      property->SetShade(c, options.shade == "on");
    }
    const ShadingTerms& terms = options.shading;
    property->SetAmbient(c, terms.ambient.value_or(property->GetAmbient(c)));
    property->SetDiffuse(c, terms.diffuse.value_or(property->GetDiffuse(c)));
    property->SetSpecular(c, terms.specular.value_or(property->GetSpecular(c)));
    property->SetSpecularPower(c, terms.specular_power.value_or(property->GetSpecularPower(c)));
  }
  property->SetInterpolationType(
    options.interpolation == "nearest" ? VTK_NEAREST_INTERPOLATION : VTK_LINEAR_INTERPOLATION);
  scene.opacity_unit_distance = property->GetScalarOpacityUnitDistance();
  scene.volume->SetProperty(property);
}

/// Says, once, that an option of gradient shading has no part in the picture; nothing where it has one.
void remark_unused_shading(const VolumeScene& scene)
{
  static bool said = false;
  const std::string given = scene.options.shading.given();
  const std::string& mode = scene.options.modes.blend_mode;
  const std::string why = given.empty() || scene.options.quiet ? ""
    : !scene.volume                     ? "there is no volume"
    : scene.options.density()           ? "a density is not shaded by its gradient"
    : mode != "composite" && mode != "isosurface" ? "--blend-mode " + mode + " is not shaded"
    : !scene.volume->GetProperty()->GetShade() ? "add --shade on"
                                               : "";
  if (!why.empty() && !said)
  {
    std::cerr << "brume: " << given << ": it changes nothing: " << why << '\n';
    said = true;
  }
}

/// Lights, medium and fog, in the sky that the scene has.
void give_light_and_matter(VolumeScene& scene)
{
  const SceneOptions& options = scene.options;
  scene.lights = make_lights(options.medium);
  scene.medium = make_medium(options.medium, options.extinction);
  scene.fog = make_fog(options.medium, scene.sky);
}

/// The preset that the options name, or that suits the data; none for a density.
void settle_preset(VolumeScene& scene)
{
  scene.preset = nullptr;
  scene.preset_reason.clear();
  if (scene.options.density())
  {
    return;
  }
  if (!scene.options.preset.empty())
  {
    scene.preset = &find_preset(scene.options.preset);
    return;
  }
  const PresetChoice choice = choose_preset(scene.input.data());
  scene.preset = choice.preset;
  scene.preset_reason = choice.reason;
}

template <class Point>
bool same_points(const std::vector<Point>& a, const std::vector<Point>& b)
{
  static_assert(std::is_trivially_copyable_v<Point>);
  return a.size() == b.size() &&
    (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Point)) == 0);
}

/// Whether the volume's property is made of the same.
bool same_look(const SceneOptions& a, const SceneOptions& b)
{
  return a.preset == b.preset && a.density() == b.density() &&
    a.opacity_unit_distance == b.opacity_unit_distance && a.shade == b.shade &&
    a.shading == b.shading &&
    a.interpolation == b.interpolation && same_points(a.colour, b.colour) &&
    same_points(a.opacity, b.opacity) && a.modes.isovalues == b.modes.isovalues;
}

bool same_sky(const MediumOptions& a, const MediumOptions& b)
{
  const auto lit = [](const MediumOptions& o) { return o.has_medium() || o.has_fog(); };
  return lit(a) == lit(b) && a.sky_radiance == b.sky_radiance &&
    a.ground_radiance == b.ground_radiance && a.up == b.up && a.environment == b.environment &&
    a.environment_lights == b.environment_lights && a.environment_rotation == b.environment_rotation;
}

/// What is behind, and how large an error may be, where the user left it open.
void settle(SceneOptions& options)
{
  options.tolerance = options.tolerance_choice.value_or(options.tolerance);
  const bool shines = options.medium.has_medium() || options.medium.has_fog();
  const double behind = options.density() && !shines ? 1.0 : 0.0;
  options.background =
    options.background_choice.value_or(std::array<double, 3>{ behind, behind, behind });
}

}

VolumeScene make_volume_scene(const SceneOptions& options)
{
  VolumeScene scene;
  scene.options = options;
  settle(scene.options);
  if (!options.preset.empty())
  {
    scene.preset = &find_preset(options.preset); // before the work of reading
  }
  check(options);
  for (const std::string& mesh : options.meshes)
  {
    scene.meshes.push_back(open_mesh(mesh));
  }
  scene.sky = make_sky(options.medium, options.choice.max_memory);
  if (options.input.empty())
  {
    scene.lights = make_lights(options.medium);
    scene.fog = make_fog(options.medium, scene.sky);
    scene.camera = make_camera(scene);
    remark_unused_shading(scene);
    return scene;
  }
  scene.input = open_input_with_bar(options.input, options.choice, options.quiet);
  choose_array(scene.input, options.density_array, options.input);
  settle_preset(scene);
  if (!options.quiet)
  {
    for (const std::string& message : scene.input.messages)
    {
      std::cerr << "brume: " << options.input << ": " << message << '\n';
    }
    if (options.verbose && !scene.preset_reason.empty())
    {
      std::cerr << "brume: " << options.input << ": preset " << scene.preset->name << ": "
                << scene.preset_reason << '\n';
    }
  }

  check_sample_distance(scene);
  scene.mask = open_mask(options.modes, scene.input.image, options.input,
    options.choice.max_memory, options.quiet);
  InterruptionWatch::check(options.input.c_str());
  scene.voxel_edge = smallest_edge(scene.input);
  scene.volume = vtkSmartPointer<vtkVolume>::New();
  give_property(scene);
  remark_unused_shading(scene);
  give_light_and_matter(scene);
  InterruptionWatch::check(options.input.c_str());
  scene.camera = make_camera(scene);
  return scene;
}

void update(VolumeScene& scene, const SceneOptions& options)
{
  check(options);
  VolumeScene next = scene;
  next.options = options;
  settle(next.options);
  if (!same_sky(scene.options.medium, options.medium))
  {
    const bool same_picture =
      scene.sky && scene.options.medium.environment == options.medium.environment;
    next.sky = make_sky(options.medium,
      options.choice.max_memory,
      same_picture ? scene.sky->GetEnvironmentMap() : nullptr);
  }
  give_light_and_matter(next);
  if (next.volume)
  {
    check_sample_distance(next);
    if (!same_look(scene.options, options))
    {
      settle_preset(next);
      give_property(next);
    }
  }
  scene = std::move(next);
}

namespace
{

/// What all of Brume's mappers take.
void give_scene(const VolumeScene& scene, vtkBrumeVolumeMapper* mapper)
{
  const SceneOptions& options = scene.options;
  mapper->SetInputDataObject(scene.input.data());
  mapper->SetExtinction(scene.medium ? 0.0 : largest(options.extinction));
  mapper->SetMedium(scene.medium);
  mapper->SetSky(scene.sky);
  mapper->SetFog(scene.fog);
  mapper->SetTolerance(options.tolerance);
  mapper->SetNumberOfThreads(options.threads);
  apply(options.modes, mapper, scene.volume->GetProperty());
  mapper->SetMaskInput(scene.mask);
  mapper->SetMaskTypeToBinary();
  scene.volume->SetMapper(mapper);
  fit_clipping_range(scene);
}

}

void set_up(const VolumeScene& scene, vtkBrumeRayMarchMapper* mapper)
{
  give_scene(scene, mapper);
  apply(scene.options.medium, mapper);
  if (scene.options.sample_distance)
  {
    mapper->AutoAdjustSampleDistancesOff();
    mapper->SetSampleDistance(*scene.options.sample_distance);
  }
}

void set_up(const VolumeScene& scene, vtkBrumePathTraceMapper* mapper)
{
  give_scene(scene, mapper);
  const PathOptions& paths = scene.options.paths;
  mapper->SetSamplesPerPixel(paths.samples_per_pixel.value_or(mapper->GetSamplesPerPixel()));
  mapper->SetMaximumScatterings(paths.scatterings.value_or(mapper->GetMaximumScatterings()));
  mapper->SetTimeBudget(paths.seconds.value_or(mapper->GetTimeBudget()));
  mapper->SetSeed(paths.seed.value_or(mapper->GetSeed()));
}

void set_up(const VolumeScene& scene, vtkBrumeSmartVolumeMapper* mapper)
{
  give_scene(scene, mapper);
  const PathOptions& paths = scene.options.paths;
  mapper->SetTimeBudget(paths.seconds.value_or(mapper->GetTimeBudget()));
  mapper->SetSeed(paths.seed.value_or(mapper->GetSeed()));
  if (paths.seconds && !scene.options.tolerance_choice)
  {
    mapper->SetTolerance(0.0);
  }
}

std::array<double, 6> VolumeScene::bounds() const
{
  std::array<double, 6> bounds;
  if (this->input.sparse)
  {
    this->input.sparse->GetBounds(bounds.data());
    return bounds;
  }
  if (this->input.image)
  {
    this->input.image->GetBounds(bounds.data());
    return bounds;
  }
  vtkBoundingBox box;
  for (vtkPolyData* mesh : this->meshes)
  {
    box.AddBounds(mesh->GetBounds());
  }
  box.GetBounds(bounds.data());
  return bounds;
}

Cropping cropping_of_voxels(const VolumeScene& scene)
{
  return scene.options.modes.cropping ? PlainScene(scene).scene()->volumes[0].cropping : Cropping();
}

void fit_clipping_range(const VolumeScene& scene)
{
  if (scene.volume && !scene.volume->GetMapper())
  {
    // Its mapper tells where a volume is: one that will never draw.
    vtkNew<vtkBrumeRayMarchMapper> mapper;
    mapper->SetInputDataObject(scene.input.data());
    scene.volume->SetMapper(mapper);
    fit_clipping_range(scene);
    scene.volume->SetMapper(nullptr);
    return;
  }
  if (scene.meshes.empty())
  {
    vtkBrumeVolumeMapper::ResetClippingRange(scene.volume, scene.camera);
    return;
  }
  vtkBoundingBox box;
  if (scene.volume)
  {
    box.AddBounds(scene.volume->GetBounds());
  }
  for (vtkPolyData* mesh : scene.meshes)
  {
    box.AddBounds(mesh->GetBounds());
  }
  double bounds[6];
  box.GetBounds(bounds);
  vtkNew<vtkRenderer> renderer; // for its method alone; nothing is drawn
  renderer->SetActiveCamera(scene.camera);
  renderer->SetNearClippingPlaneTolerance(0.0005);
  renderer->ResetCameraClippingRange(bounds);
}

std::string words_of_vtk(const std::string& error)
{
  // "ERROR: In FILE, line N\nCLASS (ADDRESS): scalars of 3 components are not drawn: take one …"
  const std::size_t address = error.find("): ");
  std::string words = address == std::string::npos ? error : error.substr(address + 3);
  words.erase(words.find_last_not_of("\n ") + 1);
  std::replace(words.begin(), words.end(), '\n', ' ');
  return words.empty() ? "see brume info" : words;
}

}
