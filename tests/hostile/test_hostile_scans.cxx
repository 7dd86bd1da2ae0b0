// Damaged scans: every format that vtkBrumeImageReader opens.
#include "read_image.h"

#include "../support/dicom_files.h"
#include "../unit/scan_files.h"

#include "vtkFloatArray.h"
#include "vtkStructuredPoints.h"
#include "vtkStructuredPointsWriter.h"
#include "vtkXMLImageDataWriter.h"

using namespace hostile;
using scan_files::deflated;
using scan_files::nifti_header;
using scan_files::nifti2_header;
using scan_files::NiftiOptions;
using scan_files::text_voxels;
using scan_files::voxels;

TEST(HostileFiles, Nifti)
{
  NiftiOptions plain, turned, series;
  turned.qform = 1;
  turned.quaternion[2] = 0.6f;
  turned.slope = 2;
  turned.swap = true;
  series.dim[0] = 4;
  series.dim[4] = 3;
  series.units = 2 | 8;
  const std::string three = voxels() + voxels() + voxels();
  NiftiOptions pair;
  pair.magic = "ni1";
  const scan_files::Affine affine{ { 0, 2, 0, 4, 1, 0, 0, 5, 0, 0, -3, 6 } };
  try_reader({ alone("a.nii", nifti_header(plain) + voxels()),
               alone("b.nii", nifti2_header(affine, 4) + voxels()),
               alone("c.nii.gz", deflated(nifti2_header(affine, 4, true) + voxels(true))),
               alone("a.nii", nifti_header(turned) + voxels(true)),
               alone("a.nii", nifti_header(series) + three),
               alone("a.nii.gz", deflated(nifti_header(series) + three)),
               { "a.hdr", { { "a.hdr", nifti_header(pair) }, { "a.img", voxels() } } } },
    read_image);
}

TEST(HostileFiles, MetaImage)
{
  const std::string head = "ObjectType = Image\nNDims = 3\nBinaryData = True\n"
                           "BinaryDataByteOrderMSB = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n"
                           "Offset = 1 2 3\nElementSpacing = 1 2 3\nDimSize = 5 4 3\n"
                           "AnatomicalOrientation = RAI\nElementType = MET_SHORT\n";
  const std::string series = "ObjectType = Image\nNDims = 4\nDimSize = 5 4 3 3\n"
                             "ElementSpacing = 1 1 1 0.25\nElementType = MET_SHORT\n";
  const std::string three = voxels() + voxels() + voxels();
  try_reader({ alone("a.mha", head + "ElementDataFile = LOCAL\n" + voxels()),
               alone("b.mha",
                 head + "CompressedData = True\nElementDataFile = LOCAL\n" + deflated(voxels(), 15)),
               alone("c.mha",
                 "NDims = 3\nDimSize = 5 4 3\nElementType = MET_FLOAT\nBinaryData = False\n"
                 "ElementToIntensityFunctionSlope = 0.5\nElementDataFile = LOCAL\n" +
                   text_voxels()),
               alone("d.mha", series + "ElementDataFile = LOCAL\n" + three),
               { "e.mhd",
                 { { "e.mhd", series + "ElementDataFile = v%d.raw 0 2 1\n" }, { "v0.raw", voxels() },
                   { "v1.raw", voxels() }, { "v2.raw", voxels() } } } },
    read_image);
}

TEST(HostileFiles, Nrrd)
{
  const std::string head = "NRRD0005\ntype: short\nendian: little\ndimension: 3\nsizes: 5 4 3\n"
                           "space: left-posterior-superior\n"
                           "space directions: (1,0,0) (0,2,0.5) (0,-0.5,3)\nspace origin: (4,5,6)\n"
                           "kinds: domain domain domain\n";
  const std::string series = "NRRD0005\ntype: short\nendian: big\ndimension: 4\nsizes: 5 4 3 3\n"
                             "kinds: domain domain domain time\nspacings: 1 1 1 20\n"
                             "units: \"mm\" \"mm\" \"mm\" \"ms\"\n";
  const std::string three = voxels() + voxels() + voxels();
  try_reader({ alone("a.nrrd", head + "encoding: raw\n\n" + voxels()),
               alone("b.nrrd", head + "encoding: gzip\n\n" + deflated(voxels())),
               alone("c.nrrd", head + "encoding: ascii\n\n" + text_voxels()),
               alone("d.nrrd", series + "encoding: raw\n\n" + three),
               alone("e.nrrd", series + "encoding: gzip\n\n" + deflated(three)),
               { "f.nhdr",
                 { { "f.nhdr", head + "encoding: raw\ndata file: f.raw\n\n" },
                   { "f.raw", voxels() } } } },
    read_image);
}

namespace
{

vtkSmartPointer<vtkImageData> image_of_two_arrays()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(5, 4, 3);
  image->SetSpacing(1, 2, 3);
  image->AllocateScalars(VTK_SHORT, 1);
  image->GetPointData()->GetScalars()->SetName("amount");
  vtkNew<vtkFloatArray> more;
  more->SetName("more");
  more->SetNumberOfComponents(3);
  more->SetNumberOfTuples(60);
  for (int i = 0; i < 60; ++i)
  {
    image->GetPointData()->GetScalars()->SetComponent(i, 0, 17 * i % 101);
    more->SetTuple3(i, i, 0.5 * i, -i);
  }
  image->GetPointData()->AddArray(more);
  return image;
}

}

TEST(HostileFiles, VtkXml)
{
  std::vector<Example> examples;
  for (int mode = 0; mode < 5; ++mode)
  {
    vtkNew<vtkXMLImageDataWriter> writer;
    writer->SetInputData(image_of_two_arrays());
    writer->SetDataMode(mode == 0 ? vtkXMLWriter::Ascii
        : mode < 3                ? vtkXMLWriter::Binary
                                  : vtkXMLWriter::Appended);
    writer->SetEncodeAppendedData(mode == 3);
    writer->SetCompressorType(
      mode == 1 ? vtkXMLWriter::NONE : mode == 4 ? vtkXMLWriter::LZ4 : vtkXMLWriter::ZLIB);
    writer->WriteToOutputStringOn();
    writer->Write();
    examples.push_back(alone("a.vti", writer->GetOutputString()));
  }
  try_reader(examples, read_image);
}

TEST(HostileFiles, LegacyVtk)
{
  const std::string head = "# vtk DataFile Version 3.0\ntitle\n";
  const std::string lattice = "DATASET STRUCTURED_POINTS\nDIMENSIONS 5 4 3\nORIGIN 1 2 3\n"
                              "SPACING 1 1 2\nPOINT_DATA 60\n";
  std::vector<Example> examples{
    alone("a.vtk", head + "ASCII\n" + lattice + "SCALARS a short 1\nLOOKUP_TABLE default\n" + text_voxels()),
    alone("b.vtk", head + "BINARY\n" + lattice + "SCALARS a short 1\nLOOKUP_TABLE default\n" + voxels(true)),
    alone("c.vtk", head + "ASCII\n" + lattice + "FIELD f 1\na 1 60 float\n" + text_voxels()),
    alone("d.vtk",
      head + "BINARY\n" + lattice + "COLOR_SCALARS a 2\n" + voxels().substr(0, 120) + "\n"),
  };
  for (bool binary : { false, true })
  {
    vtkNew<vtkStructuredPoints> points;
    points->ShallowCopy(image_of_two_arrays());
    points->GetPointData()->SetActiveScalars("");
    vtkNew<vtkStructuredPointsWriter> writer;
    writer->SetInputData(points);
    writer->SetFileType(binary ? VTK_BINARY : VTK_ASCII);
    writer->WriteToOutputStringOn();
    writer->Write();
    examples.push_back(alone("e.vtk", writer->GetOutputStdString()));
  }
  try_reader(examples, read_image);
}

TEST(HostileFiles, Dicom)
{
  const std::string here = scan_files::folder();
  std::vector<Example> examples;
  const auto add = [&](const dicom_files::Series& s)
  {
    const std::string folder = here + std::to_string(examples.size());
    Example example{ ".", {} };
    std::string last;
    for (const std::string& name : dicom_files::write(s, folder))
    {
      last = std::filesystem::path(name).filename().string();
      example.files[last] = scan_files::load(name);
    }
    examples.push_back(example);
    examples.push_back(alone(last, example.files[last]));
  };
  dicom_files::Series s;
  s.size = { { 4, 3, 4 } };
  add(s);
  s.times = 2;
  add(s);
  s.times = 1;
  s.syntax = "1.2.840.10008.1.2"; // implicit
  add(s);
  s.syntax = "1.2.840.10008.1.2.5"; // RLE
  add(s);
  try_reader(examples, read_image);
}
