// Every format: a marker voxel must stand at the right place of the world, with the right value.
#include "scan_files.h"

#include "vtkBrumeImageReader.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <cmath>

using namespace scan_files;

namespace
{

struct Opened
{
  vtkSmartPointer<vtkBrumeImageReader> reader = vtkSmartPointer<vtkBrumeImageReader>::New();
  vtkImageData* image = nullptr;
  std::string error;
  std::string spilled; // what went to the standard error stream

  explicit Opened(const std::string& path)
  {
    vtkNew<vtkCallbackCommand> silent;
    silent->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
    reader->AddObserver(vtkCommand::ErrorEvent, silent);
    reader->SetFileName(path.c_str());
    ::testing::internal::CaptureStderr();
    ::testing::internal::CaptureStdout();
    reader->Update();
    spilled = ::testing::internal::GetCapturedStdout() + ::testing::internal::GetCapturedStderr();
    image = reader->GetOutput();
    error = reader->GetErrorMessage();
  }
  std::string messages() const
  {
    std::string all;
    for (int i = 0; i < reader->GetNumberOfMessages(); ++i)
    {
      all += std::string(reader->GetMessage(i)) + "\n";
    }
    return all;
  }
};

/// Every voxel of the file, by its place in the world, is there with its value.
void expect_places(const Opened& opened, const Affine& affine, double slope = 1, double intercept = 0)
{
  ASSERT_EQ(opened.error, "");
  EXPECT_EQ(opened.spilled, "");
  int dimensions[3];
  opened.image->GetDimensions(dimensions);
  EXPECT_EQ(dimensions[0] * dimensions[1] * dimensions[2], Nx * Ny * Nz);
  const std::vector<int> values = numbers();
  for (int k = 0; k < Nz; ++k)
  {
    for (int j = 0; j < Ny; ++j)
    {
      for (int i = 0; i < Nx; ++i)
      {
        const std::array<double, 3> world = apply(affine, i, j, k);
        double index[3];
        opened.image->TransformPhysicalPointToContinuousIndex(world.data(), index);
        int voxel[3];
        for (int a = 0; a < 3; ++a)
        {
          voxel[a] = static_cast<int>(std::lround(index[a]));
          ASSERT_NEAR(index[a], voxel[a], 1e-4) << "voxel " << i << ' ' << j << ' ' << k;
          ASSERT_TRUE(voxel[a] >= 0 && voxel[a] < dimensions[a]);
        }
        ASSERT_EQ(opened.image->GetScalarComponentAsDouble(voxel[0], voxel[1], voxel[2], 0),
          slope * values[i + Nx * (j + Ny * k)] + intercept)
          << "voxel " << i << ' ' << j << ' ' << k;
      }
    }
  }
  EXPECT_NEAR(opened.image->GetDirectionMatrix()->Determinant(), 1, 1e-9);
}

/// Fails with a message of one line, "FILE: what is wrong: what to do", that holds `words`.
void expect_error(const std::string& path, const std::string& words)
{
  const Opened opened(path);
  EXPECT_NE(opened.error.find(words), std::string::npos) << opened.error;
  EXPECT_EQ(opened.error.compare(0, path.size() + 2, path + ": "), 0) << opened.error;
  EXPECT_NE(opened.error.find(": ", path.size() + 2), std::string::npos) << opened.error;
  EXPECT_EQ(opened.error.find('\n'), std::string::npos) << opened.error;
  EXPECT_EQ(opened.spilled, "");
  EXPECT_EQ(opened.image->GetNumberOfPoints(), 0);
  EXPECT_EQ(opened.image->GetPointData()->GetNumberOfArrays(), 0);
}

// All 48 ways in which a grid can lie along the axes, with three different spacings.
std::vector<Affine> axis_aligned()
{
  const int orders[6][3] = { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 }, { 1, 2, 0 }, { 2, 0, 1 },
    { 2, 1, 0 } };
  std::vector<Affine> affines;
  for (const int* order : orders)
  {
    for (int signs = 0; signs < 8; ++signs)
    {
      Affine a{ { 0, 0, 0, -11, 0, 0, 0, 7, 0, 0, 0, 23 } };
      for (int axis = 0; axis < 3; ++axis)
      {
        a[4 * order[axis] + axis] = (signs >> axis & 1 ? -1 : 1) * (axis + 2.0);
      }
      affines.push_back(a);
    }
  }
  return affines;
}

NiftiOptions with_sform(const Affine& affine)
{
  NiftiOptions o;
  o.sform = 1;
  o.srow = affine;
  return o;
}

const Affine Scaled{ { 2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0 } };

std::string meta_header(const std::string& more, const std::string& data)
{
  return "ObjectType = Image\nNDims = 3\n" + more +
    "DimSize = 5 4 3\nElementType = MET_SHORT\nElementDataFile = " + data + "\n";
}

std::string nrrd_header(const std::string& more, const std::string& encoding = "raw")
{
  return "NRRD0004\n# a comment\ntype: short\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: " +
    encoding + "\n" + more;
}

std::string vti(const std::string& extent, const std::string& array, const std::string& tail = "")
{
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<ImageData WholeExtent=\"" +
    extent + "\" Origin=\"-11 7 23\" Spacing=\"2 3 4\" Direction=\"0 -1 0 1 0 0 0 0 1\">\n"
             "<Piece Extent=\"" +
    extent + "\"><PointData Scalars=\"s\">" + array + "</PointData></Piece>\n</ImageData>\n" + tail +
    "</VTKFile>\n";
}
const Affine VtiPlace{ { 0, -3, 0, -11, 2, 0, 0, 7, 0, 0, 4, 23 } };

std::string legacy(const std::string& kind, const std::string& data,
  const std::string& dimensions = "5 4 3")
{
  return "# vtk DataFile Version 3.0\na title\n" + kind +
    "\nDATASET STRUCTURED_POINTS\nDIMENSIONS " + dimensions +
    "\nSPACING 2 3 4\nORIGIN -11 7 23\nPOINT_DATA 60\nSCALARS s short 1\nLOOKUP_TABLE default\n" +
    data;
}
const Affine LegacyPlace{ { 2, 0, 0, -11, 0, 3, 0, 7, 0, 0, 4, 23 } };

}

TEST(NiftiReader, SformOfEveryHandednessPutsVoxelsInTheirPlace)
{
  const std::string here = folder();
  for (const Affine& affine : axis_aligned())
  {
    const Opened opened(save(here + "a.nii", nifti_header(with_sform(affine)) + voxels()));
    expect_places(opened, affine);
    EXPECT_TRUE(opened.reader->GetPatientAxes());
    EXPECT_STREQ(opened.reader->GetLengthUnit(), "mm");
    double spacing[3];
    opened.image->GetSpacing(spacing);
    EXPECT_EQ(spacing[0], 2);
    EXPECT_EQ(spacing[1], 3);
    EXPECT_EQ(spacing[2], 4);
  }
}

TEST(NiftiReader, MirroredAxialScanKeepsIdentityDirection)
{
  // The commonest left-handed file: radiological order, x from right to left.
  const Affine las{ { -2, 0, 0, 90, 0, 3, 0, 0, 0, 0, 4, 0 } };
  const Opened opened(save(folder() + "a.nii", nifti_header(with_sform(las)) + voxels()));
  expect_places(opened, las);
  EXPECT_TRUE(opened.image->GetDirectionMatrix()->IsIdentity());
  EXPECT_NE(opened.messages().find("left-handed"), std::string::npos);
}

TEST(NiftiReader, QformWithBothValuesOfQfac)
{
  const std::string here = folder();
  for (float qfac : { 1.f, -1.f, 0.f })
  {
    NiftiOptions o;
    o.qform = 1;
    o.pixdim[0] = qfac;
    // A turn by 90 degrees about z: x goes to y. Then one about x.
    const float half = static_cast<float>(std::sqrt(0.5));
    const double sign = qfac < 0 ? -1 : 1;
    o.quaternion[2] = half;
    o.offset[0] = -11;
    o.offset[1] = 7;
    o.offset[2] = 23;
    expect_places(Opened(save(here + "z.nii", nifti_header(o) + voxels())),
      { { 0, -3, 0, -11, 2, 0, 0, 7, 0, 0, 4 * sign, 23 } });
    o.quaternion[0] = half;
    o.quaternion[2] = 0;
    expect_places(Opened(save(here + "x.nii", nifti_header(o) + voxels())),
      { { 2, 0, 0, -11, 0, 0, -4 * sign, 7, 0, 3, 0, 23 } });
  }
}

TEST(NiftiReader, SformGoesBeforeQformAndAnEmptyOneDoesNot)
{
  const std::string here = folder();
  NiftiOptions o = with_sform({ { 0, 3, 0, 1, 2, 0, 0, 2, 0, 0, 4, 3 } });
  o.qform = 1;
  expect_places(Opened(save(here + "a.nii", nifti_header(o) + voxels())), o.srow);
  o.srow = Affine{};
  const Opened opened(save(here + "b.nii", nifti_header(o) + voxels()));
  expect_places(opened, Scaled);
  EXPECT_NE(opened.messages().find("sform"), std::string::npos);
}

TEST(NiftiReader, BothByteOrdersPlainAndGzipped)
{
  const std::string here = folder();
  for (bool swap : { false, true })
  {
    NiftiOptions o = with_sform(axis_aligned()[13]);
    o.swap = swap;
    const std::string bytes = nifti_header(o) + voxels(swap);
    expect_places(Opened(save(here + "a.nii", bytes)), o.srow);
    expect_places(Opened(save(here + "a.nii.gz", deflated(bytes))), o.srow);
    // The content counts, not the name.
    expect_places(Opened(save(here + "a.vti", deflated(bytes))), o.srow);
    // Several gzip members in a row are one stream.
    expect_places(Opened(save(here + "b.nii.gz", deflated(bytes.substr(0, 400)) +
                    deflated(bytes.substr(400)))), o.srow);
  }
}

TEST(NiftiReader, HeaderAndDataInTwoFilesAndAnalyze)
{
  const std::string here = folder();
  NiftiOptions o = with_sform(axis_aligned()[5]);
  o.magic = "ni1";
  save(here + "a.hdr", nifti_header(o).substr(0, 348));
  save(here + "a.img", voxels());
  expect_places(Opened(here + "a.hdr"), o.srow);
  expect_places(Opened(here + "a.img"), o.srow);
  save(here + "b.hdr", nifti_header(o).substr(0, 348));
  save(here + "b.img.gz", deflated(voxels()));
  expect_places(Opened(here + "b.hdr"), o.srow);
  o.magic = "";
  save(here + "c.hdr", nifti_header(o).substr(0, 348));
  save(here + "c.img", voxels());
  const Opened analyze(here + "c.hdr");
  expect_places(analyze, Scaled);
  EXPECT_FALSE(analyze.reader->GetPatientAxes());
  std::filesystem::remove(here + "a.img");
  expect_error(here + "a.hdr", "is not there");
  std::filesystem::remove(here + "b.hdr");
  expect_error(here + "b.img.gz", "not beside it");
}

TEST(NiftiReader, Nifti2)
{
  const Affine affine = axis_aligned()[21];
  for (bool swap : { false, true })
  {
    const std::string h = nifti2_header(affine, 16, swap);
    const std::string here = folder();
    const Opened plain(save(here + "a.nii", h + voxels<float>(swap)));
    expect_places(plain, affine);
    EXPECT_STREQ(plain.reader->GetFormat(), "NIfTI-2");
    expect_places(Opened(save(here + "a.nii.gz", deflated(h + voxels<float>(swap)))), affine);
    expect_error(save(here + "c.nii", h.substr(0, 500)), "cut short within its header");
    std::string many = h;
    put<std::int64_t>(many, 24, std::int64_t(1) << 40, swap);
    expect_error(save(here + "d.nii", many + voxels<float>(swap)), "axis 1");
    put<std::int64_t>(many, 24, Nx, swap);
    put<std::int64_t>(many, 168, -1, swap);
    expect_error(save(here + "e.nii", many + voxels<float>(swap)), "vox_offset");
  }
  std::string text = nifti2_header(affine, 16);
  put<char>(text, 8, '\n'); // as a transfer in text mode leaves it
  expect_error(save(folder() + "b.nii", text + voxels<float>()), "text mode");
}

TEST(NiftiReader, SlopeUnitsAndTypes)
{
  const std::string here = folder();
  NiftiOptions o;
  o.slope = 0.5f;
  o.intercept = -1024;
  const Opened scaled(save(here + "a.nii", nifti_header(o) + voxels()));
  expect_places(scaled, Scaled, 0.5, -1024);
  EXPECT_EQ(scaled.image->GetScalarType(), VTK_FLOAT);
  EXPECT_FALSE(scaled.reader->GetPatientAxes());

  NiftiOptions micro = with_sform(Scaled);
  micro.units = 3; // micrometres
  Affine small = Scaled;
  for (double& a : small)
  {
    a *= 1e-3;
  }
  const Opened converted(save(here + "b.nii", nifti_header(micro) + voxels()));
  expect_places(converted, small);
  EXPECT_STREQ(converted.reader->GetLengthUnit(), "mm");

  o = NiftiOptions();
  o.datatype = 64;
  const Opened doubles(save(here + "c.nii", nifti_header(o) + voxels<double>()));
  expect_places(doubles, Scaled);
  EXPECT_EQ(doubles.image->GetScalarType(), VTK_DOUBLE);
  o.datatype = 512;
  EXPECT_EQ(Opened(save(here + "d.nii", nifti_header(o) + voxels<std::uint16_t>()))
              .image->GetScalarType(), VTK_UNSIGNED_SHORT);
  o.datatype = 1536; // 128-bit float
  expect_error(save(here + "e.nii", nifti_header(o) + voxels<double>()), "type 1536");
}

TEST(NiftiReader, ShearGivesTheClosestFrameAndKeepsTheCentre)
{
  // A gantry tilt: slices move along y as they go up.
  const double tilt = 0.2;
  const Affine sheared{ { 2, 0, 0, 0, 0, 3, 4 * std::sin(tilt), 0, 0, 0, 4 * std::cos(tilt), 0 } };
  const Opened opened(save(folder() + "a.nii", nifti_header(with_sform(sheared)) + voxels()));
  ASSERT_EQ(opened.error, "");
  EXPECT_NE(opened.messages().find("not perpendicular"), std::string::npos);
  // The closest frame splits the tilt between the two axes that are not perpendicular.
  vtkMatrix3x3* d = opened.image->GetDirectionMatrix();
  EXPECT_NEAR(d->GetElement(1, 2), std::sin(tilt / 2), 1e-6);
  EXPECT_NEAR(d->GetElement(2, 1), -std::sin(tilt / 2), 1e-6);
  const std::array<double, 3> centre = apply(sheared, 2, 1.5, 1);
  double got[3];
  const double index[3] = { 2, 1.5, 1 };
  opened.image->TransformContinuousIndexToPhysicalPoint(index, got);
  for (int a = 0; a < 3; ++a)
  {
    EXPECT_NEAR(got[a], centre[a], 1e-6);
  }
}

TEST(NiftiReader, ObliqueScan)
{
  // 30 degrees about z, left-handed.
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  const Affine oblique{ { -2 * c, -3 * s, 0, 10, -2 * s, 3 * c, 0, 20, 0, 0, 4, 30 } };
  const Opened opened(save(folder() + "a.nii", nifti_header(with_sform(oblique)) + voxels()));
  expect_places(opened, oblique);
  EXPECT_EQ(opened.messages().find("perpendicular"), std::string::npos);
}

TEST(NiftiReader, FirstVolumeOfASeriesAndVectors)
{
  const std::string here = folder();
  NiftiOptions o = with_sform(Scaled);
  o.dim[0] = 4;
  o.dim[4] = 3;
  const std::string later(2 * voxels().size(), '\x55');
  const Opened series(save(here + "a.nii.gz", deflated(nifti_header(o) + voxels() + later)));
  expect_places(series, Scaled);
  EXPECT_NE(series.messages().find("series of 3 volumes"), std::string::npos);

  o.dim[0] = 5;
  o.dim[4] = 1;
  o.dim[5] = 2;
  const std::string second(voxels().size(), '\x01'); // 0x0101 everywhere
  const Opened vectors(save(here + "b.nii", nifti_header(o) + voxels() + second));
  expect_places(vectors, Scaled);
  EXPECT_EQ(vectors.image->GetNumberOfScalarComponents(), 2);
  EXPECT_EQ(vectors.image->GetScalarComponentAsDouble(4, 3, 2, 1), 0x0101);
}

TEST(NiftiReader, BadHeaders)
{
  const std::string here = folder();
  const auto with_dim = [&](int index, std::int16_t value)
  {
    NiftiOptions o;
    o.dim[index] = value;
    return save(here + "a.nii", nifti_header(o) + voxels());
  };
  expect_error(with_dim(0, 0), "0 dimensions");
  expect_error(with_dim(0, 9), "9 dimensions");
  expect_error(with_dim(1, 0), "0 voxels along axis 1");
  expect_error(with_dim(3, -3), "-3 voxels along axis 3");
  expect_error(with_dim(3, 30000), "cut short");
  NiftiOptions huge;
  huge.dim[1] = huge.dim[2] = huge.dim[3] = 32767;
  expect_error(save(here + "b.nii", nifti_header(huge) + voxels()), "cut short");
  expect_error(save(here + "b.nii.gz", deflated(nifti_header(huge) + voxels())), "cut short");
  std::string h = nifti_header(NiftiOptions());
  put<float>(h, 108, NAN);
  expect_error(save(here + "c.nii", h + voxels()), "vox_offset");
  put<float>(h, 108, 1e9f);
  expect_error(save(here + "d.nii", h + voxels()), "cut short");
  Affine flat = Scaled;
  flat[10] = 0;
  flat[8] = 1; // the third axis lies along the first
  flat[2] = 4;
  flat[0] = 1;
  flat[8] = 0;
  expect_error(save(here + "e.nii", nifti_header(with_sform(flat)) + voxels()), "plane");
}

TEST(NiftiReader, EveryTruncationIsAnError)
{
  const std::string here = folder();
  const std::string plain = nifti_header(with_sform(Scaled)) + voxels();
  const std::string packed = deflated(plain);
  for (std::size_t n = 0; n < plain.size(); n += 7)
  {
    EXPECT_NE(Opened(save(here + "a.nii", plain.substr(0, n))).error, "") << n;
  }
  for (std::size_t n = 0; n < packed.size(); ++n)
  {
    EXPECT_NE(Opened(save(here + "a.nii.gz", packed.substr(0, n))).error, "") << n;
  }
}

TEST(NiftiReader, DamagedGzipIsAnError)
{
  const std::string here = folder();
  // Random voxels do not pack: a wrong byte among them inflates well and only the checksum tells.
  std::string plain = nifti_header(with_sform(Scaled)) + voxels();
  std::uint32_t state = 1;
  for (std::size_t i = 352; i < plain.size(); ++i)
  {
    plain[i] = static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
  }
  std::string packed = deflated(plain);
  packed[packed.size() - 40] ^= 0x10;
  expect_error(save(here + "a.nii.gz", packed), "damaged");
}

TEST(MetaReader, PlainImageKeepsItsOwnAxes)
{
  const std::string here = folder();
  const std::string more = "ElementSpacing = 2 3 4\nOffset = -11 7 23\n";
  const Affine place = LegacyPlace;
  const Opened local(save(here + "a.mha", meta_header(more, "LOCAL") + voxels()));
  expect_places(local, place);
  EXPECT_FALSE(local.reader->GetPatientAxes());
  expect_places(Opened(save(here + "b.mha", meta_header(
    more + "AnatomicalOrientation = ???\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n", "LOCAL") + voxels())),
    place);
  expect_places(Opened(save(here + "c.mha", meta_header(
    more + "BinaryDataByteOrderMSB = True\n", "LOCAL") + voxels(true))), place);
  expect_places(Opened(save(here + "d.mha", meta_header(
    more + "CompressedData = True\n", "LOCAL") + deflated(voxels(), 15))), place);
  expect_places(Opened(save(here + "e.mha", meta_header(
    more + "BinaryData = False\n", "LOCAL") + text_voxels())), place);
}

TEST(MetaReader, AnatomyTurnsFromLpsToRas)
{
  const std::string here = folder();
  const std::string more = "ElementSpacing = 2 3 4\nOffset = -11 7 23\n";
  const Opened upright(save(here + "a.mha", meta_header(
    more + "AnatomicalOrientation = RAI\n", "LOCAL") + voxels()));
  expect_places(upright, { { -2, 0, 0, 11, 0, -3, 0, -7, 0, 0, 4, 23 } });
  EXPECT_TRUE(upright.reader->GetPatientAxes());
  EXPECT_STREQ(upright.reader->GetLengthUnit(), "mm");
  // ITK lists the direction of one index axis after another: here i runs along LPS y, j along z.
  const Opened turned(save(here + "b.mha", meta_header(
    more + "TransformMatrix = 0 1 0 0 0 1 1 0 0\n", "LOCAL") + voxels()));
  expect_places(turned, { { 0, 0, -4, 11, -2, 0, 0, -7, 0, 3, 0, 23 } });
}

TEST(MetaReader, DetachedData)
{
  const std::string here = folder();
  save(here + "a.raw", voxels());
  expect_places(Opened(save(here + "a.mhd", meta_header("ElementSpacing = 2 3 4\n", "a.raw"))), Scaled);
  save(here + "b.raw", "some header of its own" + voxels());
  expect_places(Opened(save(here + "b.mhd",
    meta_header("ElementSpacing = 2 3 4\nHeaderSize = -1\n", "b.raw"))), Scaled);
  const std::size_t slice = voxels().size() / Nz;
  for (int k = 0; k < Nz; ++k)
  {
    save(here + "s0" + std::to_string(k + 1) + ".raw", voxels().substr(k * slice, slice));
  }
  expect_places(Opened(save(here + "c.mhd",
    meta_header("ElementSpacing = 2 3 4\n", "LIST\ns01.raw\ns02.raw\ns03.raw"))), Scaled);
  expect_places(Opened(save(here + "d.mhd",
    meta_header("ElementSpacing = 2 3 4\n", "s%02d.raw 1 3 1"))), Scaled);
  expect_error(save(here + "e.mhd", meta_header("", "none.raw")), "none.raw: the data file is not there");
  expect_error(save(here + "f.mhd", meta_header("", "s%02d.raw 1 4 1")), "");
  expect_error(save(here + "g.mhd", meta_header("", "%s%s%n.raw 1 4 1")), "pattern");
  save(here + "h.raw", voxels().substr(3));
  expect_error(save(here + "h.mhd", meta_header("", "h.raw")), "cut short");
  expect_error(save(here + "i.mhd", meta_header("", ".")), "folder");
}

TEST(MetaReader, BadHeaders)
{
  const std::string here = folder();
  const std::string good = meta_header("", "LOCAL");
  expect_error(save(here + "a.mha", good.substr(0, 60)), "ElementDataFile");
  expect_error(save(here + "b.mha", "NDims = 3\nDimSize = 5 4\nElementType = MET_SHORT\n"
                                    "ElementDataFile = LOCAL\n"), "DimSize");
  expect_error(save(here + "c.mha", "NDims = 3\nDimSize = 5 -4 3\nElementType = MET_SHORT\n"
                                    "ElementDataFile = LOCAL\n"), "DimSize");
  expect_error(save(here + "d.mha", "NDims = 3\nDimSize = 5 4 3\nElementType = MET_STRING\n"
                                    "ElementDataFile = LOCAL\n"), "MET_STRING");
  expect_error(save(here + "e.mha", "NDims = 3\nDimSize = 2000000000 2000000000 2000000000\n"
                                    "ElementType = MET_SHORT\nElementDataFile = LOCAL\n"), "promises");
  expect_error(save(here + "f.mha", meta_header("ElementSpacing = 1 nan 1\n", "LOCAL") + voxels()),
    "not finite");
  expect_error(save(here + "g.mha", meta_header("ElementNumberOfChannels = 0\n", "LOCAL") + voxels()),
    "0 numbers a voxel");
  const std::string whole = meta_header("CompressedData = True\n", "LOCAL") + deflated(voxels(), 15);
  for (std::size_t n = 1; n < whole.size(); ++n)
  {
    EXPECT_NE(Opened(save(here + "t.mha", whole.substr(0, n))).error, "") << n;
  }
}

TEST(NrrdReader, SpacesBecomeRas)
{
  const std::string here = folder();
  const std::string place = "space directions: (2,0,0) (0,3,0) (0, 0, 4)\nspace origin: (-11,7,23)\n";
  const Affine ras = LegacyPlace;
  const Affine lps{ { -2, 0, 0, 11, 0, -3, 0, -7, 0, 0, 4, 23 } };
  const Affine las{ { -2, 0, 0, 11, 0, 3, 0, 7, 0, 0, 4, 23 } };
  const std::vector<std::pair<std::string, Affine>> spaces{ { "right-anterior-superior", ras },
    { "RAS", ras }, { "left-posterior-superior", lps }, { "LPS", lps },
    { "left-anterior-superior", las }, { "LAS", las } };
  for (const auto& [name, affine] : spaces)
  {
    const Opened opened(
      save(here + "a.nrrd", nrrd_header("space: " + name + "\n" + place + "\n") + voxels()));
    expect_places(opened, affine);
    EXPECT_TRUE(opened.reader->GetPatientAxes()) << name;
  }
  const Opened own(save(here + "b.nrrd",
    nrrd_header("space dimension: 3\nspace units: \"um\" \"um\" \"um\"\n" + place + "\n") + voxels()));
  expect_places(own, ras);
  EXPECT_FALSE(own.reader->GetPatientAxes());
  EXPECT_STREQ(own.reader->GetLengthUnit(), "um");
  // Oblique, and in another order of axes.
  expect_places(Opened(save(here + "c.nrrd", nrrd_header("space: LPS\nspace directions: (0,0,2) "
    "(1.8,2.4,0) (-3.2,2.4,0)\n\n") + voxels())),
    { { 0, -1.8, 3.2, 0, 0, -2.4, -2.4, 0, 2, 0, 0, 0 } });
}

TEST(NrrdReader, Encodings)
{
  const std::string here = folder();
  const std::string spacing = "spacings: 2 3 4\n";
  expect_places(Opened(save(here + "a.nrrd", nrrd_header(spacing + "\n") + voxels())), Scaled);
  expect_places(Opened(save(here + "b.nrrd", nrrd_header(spacing + "\n", "gzip") +
    deflated(voxels()))), Scaled);
  expect_places(Opened(save(here + "c.nrrd", nrrd_header(spacing + "\n", "ascii") + text_voxels())),
    Scaled);
  std::string big = nrrd_header(spacing + "\n", "gzip");
  big.replace(big.find("little"), 6, "big");
  expect_places(Opened(save(here + "d.nrrd", big + deflated(voxels(true)))), Scaled);
  std::string windows = nrrd_header(spacing + "\n");
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2)
  {
    windows.insert(at, "\r");
  }
  expect_places(Opened(save(here + "e.nrrd", windows + voxels())), Scaled);
  save(here + "f.raw", voxels());
  expect_places(Opened(save(here + "f.nhdr", nrrd_header(spacing + "data file: f.raw\n"))), Scaled);
  save(here + "g.raw", "12345" + voxels());
  expect_places(Opened(save(here + "g.nhdr",
    nrrd_header(spacing + "byte skip: 5\ndata file: g.raw\n"))), Scaled);
  expect_places(Opened(save(here + "h.nhdr",
    nrrd_header(spacing + "byteskip: -1\ndatafile: g.raw\n"))), Scaled);
  std::string bytes = nrrd_header(spacing + "\n", "ascii");
  bytes.replace(bytes.find("short"), 5, "float");
  const Opened floats(save(here + "i.nrrd", bytes + text_voxels()));
  expect_places(floats, Scaled);
  EXPECT_EQ(floats.image->GetScalarType(), VTK_FLOAT);
}

TEST(NrrdReader, ComponentsAndSeries)
{
  const std::string here = folder();
  const std::string head = "NRRD0005\ntype: uchar\nencoding: raw\ndimension: 4\n";
  const std::string bytes(3 * 60, '\x07');
  const Opened colour(save(here + "a.nrrd",
    head + "sizes: 3 5 4 3\nkinds: RGB-color domain domain domain\n\n" + bytes));
  ASSERT_EQ(colour.error, "");
  EXPECT_EQ(colour.image->GetNumberOfScalarComponents(), 3);
  EXPECT_EQ(colour.image->GetDimensions()[0], 5);
  const Opened series(save(here + "b.nrrd",
    head + "sizes: 5 4 3 3\nspace: RAS\nspace directions: (1,0,0) (0,1,0) (0,0,1) none\n\n" + bytes));
  ASSERT_EQ(series.error, "");
  EXPECT_NE(series.messages().find("series of 3"), std::string::npos);
  EXPECT_EQ(series.image->GetNumberOfPoints(), 60);
  // VTK 9.1 takes a short first axis for components; nothing here says that it is.
  const Opened thin(save(here + "c.nrrd",
    "NRRD0005\ntype: uchar\nencoding: raw\ndimension: 3\nsizes: 3 5 12\n\n" + bytes));
  ASSERT_EQ(thin.error, "");
  EXPECT_EQ(thin.image->GetNumberOfScalarComponents(), 1);
  EXPECT_EQ(thin.image->GetDimensions()[0], 3);
}

TEST(NrrdReader, BadHeaders)
{
  const std::string here = folder();
  const auto changed = [&](const std::string& from, const std::string& to)
  {
    std::string bytes = nrrd_header("\n");
    bytes.replace(bytes.find(from), from.size(), to);
    return save(here + "a.nrrd", bytes + voxels());
  };
  expect_error(changed("sizes: 5 4 3", "sizes: 5 4 0"), "sizes");
  expect_error(changed("sizes: 5 4 3", "sizes: 5 4 -3"), "sizes");
  expect_error(changed("sizes: 5 4 3", "sizes: 5 4 1e400"), "sizes");
  expect_error(changed("sizes: 5 4 3", "sizes: 5 4 3 2"), "disagree");
  expect_error(changed("sizes: 5 4 3", "sizes: 5 4 4"), "cut short");
  expect_error(changed("type: short", "type: block"), "block");
  expect_error(changed("endian: little", "endian: none"), "endian");
  expect_error(changed("encoding: raw", "encoding: bzip2"), "bzip2");
  expect_error(changed("encoding: raw", "encoding: gzip"), "damaged");
  expect_error(changed("# a comment", "space: left-posterior-superior-time"), "time");
  expect_error(save(here + "b.nrrd", nrrd_header("\n", "ascii") + "1 2 three 4 5 6 7 8 9 " +
                 std::string(300, '1')), "three");
  expect_error(save(here + "c.nhdr", nrrd_header("data file: none.raw\n")), "not there");
  const std::string packed = nrrd_header("\n", "gzip") + deflated(voxels());
  const std::string text = nrrd_header("\n", "ascii") + text_voxels();
  for (std::size_t n = 1; n < packed.size(); ++n)
  {
    EXPECT_NE(Opened(save(here + "t.nrrd", packed.substr(0, n))).error, "") << n;
  }
  for (std::size_t n = 1; n + 3 < text.size(); ++n)
  {
    EXPECT_NE(Opened(save(here + "t.nrrd", text.substr(0, n))).error, "") << n;
  }
}

TEST(VtiReader, AsciiAndAppendedRaw)
{
  const std::string here = folder();
  const std::string array = "<DataArray type=\"Int16\" Name=\"s\" format=\"ascii\">" + text_voxels() +
    "</DataArray>";
  expect_places(Opened(save(here + "a.vti", vti("0 4 0 3 0 2", array))), VtiPlace);
  std::string blob(8, '\0');
  put<std::uint64_t>(blob, 0, voxels().size());
  const std::string raw = vti("0 4 0 3 0 2",
    "<DataArray type=\"Int16\" Name=\"s\" format=\"appended\" offset=\"0\"/>",
    "<AppendedData encoding=\"raw\">_" + blob + voxels() + "</AppendedData>\n");
  expect_places(Opened(save(here + "b.vti", raw)), VtiPlace);
  for (std::size_t n = 1; n + 1 < raw.size(); n += 3)
  {
    const Opened opened(save(here + "t.vti", raw.substr(0, n)));
    EXPECT_NE(opened.error, "") << n;
    EXPECT_EQ(opened.spilled, "") << n;
  }
}

TEST(VtiReader, BadFiles)
{
  const std::string here = folder();
  const std::string array = "<DataArray type=\"Int16\" Name=\"s\" format=\"ascii\">" + text_voxels() +
    "</DataArray>";
  expect_error(save(here + "a.vti", vti("0 4 0 3 0 2000000000", array)), "promises more");
  expect_error(save(here + "b.vti", vti("0 -1 0 3 0 2", array)), "no voxels");
  expect_error(save(here + "c.vti", vti("0 4 0 3 0 2", "")), "no numbers");
  std::string poly = vti("0 4 0 3 0 2", array);
  poly.replace(poly.find("ImageData"), 9, "PolyData");
  expect_error(save(here + "d.vti", poly), "no image data");
  std::string broken = vti("0 4 0 3 0 2", array);
  broken.replace(broken.find("</PointData>"), 12, "</PointMuta>");
  expect_error(save(here + "e.vti", broken), "VTK cannot read it");
  expect_error(save(here + "f.vti", vti("0 4 0 3 0 3", array)), "");
  std::string untyped = vti("0 4 0 3 0 2", array);
  untyped.replace(untyped.find("type=\"Int16\""), 12, "");
  expect_error(save(here + "g.vti", untyped), "VTK cannot read it"); // told by no reader's event
}

TEST(LegacyReader, AsciiAndBinary)
{
  const std::string here = folder();
  expect_places(Opened(save(here + "a.vtk", legacy("ASCII", text_voxels()))), LegacyPlace);
  const std::string binary = legacy("BINARY", voxels(true) + "\n"); // big endian, by the format
  expect_places(Opened(save(here + "b.vtk", binary)), LegacyPlace);
  for (std::size_t n = 1; n + 1 < binary.size(); ++n)
  {
    const Opened opened(save(here + "t.vtk", binary.substr(0, n)));
    EXPECT_NE(opened.error, "") << n;
    EXPECT_EQ(opened.spilled, "") << n;
  }
  const std::string text = legacy("ASCII", text_voxels());
  for (std::size_t n = 1; n + 3 < text.size(); ++n)
  {
    EXPECT_NE(Opened(save(here + "t.vtk", text.substr(0, n))).error, "") << n;
  }
}

TEST(LegacyReader, BadFiles)
{
  const std::string here = folder();
  expect_error(save(here + "a.vtk", legacy("ASCII", text_voxels(), "5 4 -3")), "DIMENSIONS");
  expect_error(save(here + "b.vtk", legacy("BINARY", voxels(true), "500 400 3000")), "POINT_DATA");
  std::string more = legacy("BINARY", voxels(true), "500 400 3000");
  more.replace(more.find("POINT_DATA 60"), 13, "POINT_DATA 600000000");
  expect_error(save(here + "e.vtk", more), "cut short");
  expect_error(save(here + "f.vtk", legacy("ASCII", "1 2 three " + text_voxels())), "three");
  std::string poly = legacy("ASCII", text_voxels());
  poly.replace(poly.find("STRUCTURED_POINTS"), 17, "POLYDATA");
  expect_error(save(here + "c.vtk", poly), "polydata, not structured points");
  expect_error(save(here + "d.vtk", legacy("NEITHER", text_voxels())), "ASCII nor BINARY");
}

TEST(ImageReader, FilesThatAreNoVolume)
{
  const std::string here = folder();
  expect_error(here + "missing.nii", "no such file");
  expect_error(here + "no/such/folder.nii", "no such file");
  expect_error(std::filesystem::path(here).parent_path().string(), "is a folder");
  expect_error(save(here + "empty.nii.gz", ""), "is empty");
  expect_error(save(here + "text.nii.gz", "I am a text.\n"), "plain text");
  expect_error(save(here + "text.nii", "I am a text.\n"), "plain text");
  expect_error(save(here + "a.nii.gz", deflated("I am a text, compressed.\n")), "compressed");
  expect_error(save(here + "a.gz", deflated("I am a text, compressed.\n")), "compressed");
  expect_error(save(here + "a.nii.gz", "\x1f\x8b\x08 and then nonsense"), "");
  expect_error(save(here + "a.dcm", std::string(128, '\0') + "DICM" + std::string(99, '\0')), "DICOM");
  expect_error(save(here + "a.vdb", std::string(" BDV\0\0\0\0", 8) + std::string(99, '\0')), "OpenVDB");
  expect_error(save(here + "a.png", "\x89PNG\r\n\x1a\n"), "picture");
  expect_error(save(here + "a.raw", std::string(5000, '\3')), "a.raw.json");
  expect_error(save(here + "a.xyz", std::string(5000, '\3')), "is no volume");
  expect_error("/dev/null", "regular file");
  const std::string locked = save(here + "locked.nii", nifti_header(NiftiOptions()) + voxels());
  if (geteuid() != 0) // nothing is locked for root
  {
    std::filesystem::permissions(locked, std::filesystem::perms::none);
    expect_error(locked, "cannot be opened");
    std::filesystem::permissions(locked, std::filesystem::perms::owner_all);
  }
}

TEST(ImageReader, ReadsAgainAfterAnErrorAndAnotherFile)
{
  const std::string here = folder();
  Opened opened(here + "missing.nii");
  EXPECT_NE(opened.error, "");
  opened.reader->SetFileName(
    save(here + "a.nii", nifti_header(with_sform(Scaled)) + voxels()).c_str());
  opened.reader->Update();
  opened.error = opened.reader->GetErrorMessage();
  opened.image = opened.reader->GetOutput();
  expect_places(opened, Scaled);
  opened.reader->SetFileName(save(here + "b.vti", vti("0 4 0 3 0 2",
    "<DataArray type=\"Int16\" Name=\"s\" format=\"ascii\">" + text_voxels() + "</DataArray>")).c_str());
  opened.reader->Update();
  opened.image = opened.reader->GetOutput();
  expect_places(opened, VtiPlace);
  EXPECT_STREQ(opened.reader->GetLengthUnit(), "");
  // The output released and asked for again.
  opened.image->ReleaseData();
  opened.reader->Modified();
  opened.reader->Update();
  opened.image = opened.reader->GetOutput();
  expect_places(opened, VtiPlace);
  EXPECT_TRUE(vtkBrumeImageReader::CanReadFile((here + "b.vti").c_str()));
  EXPECT_FALSE(vtkBrumeImageReader::CanReadFile((here + "missing.nii").c_str()));
}

TEST(ImageReader, DataReleasedIsReadAgain)
{
  const std::string here = folder();
  for (const std::string& path :
    { save(here + "a.nii", nifti_header(with_sform(VtiPlace)) + voxels()),
      save(here + "b.vti", vti("0 4 0 3 0 2", "<DataArray type=\"Int16\" Name=\"s\" "
                                              "format=\"ascii\">" + text_voxels() + "</DataArray>")) })
  {
    Opened opened(path);
    opened.image->ReleaseData();
    opened.reader->Update();
    expect_places(opened, VtiPlace);
  }
}
