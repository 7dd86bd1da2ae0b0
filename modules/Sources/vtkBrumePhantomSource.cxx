#include "vtkBrumePhantomSource.h"

#include "vtkBrumeSourceTools.h"

#include "data-generators/exact_field.h"
#include "data-generators/head_ct.h"
#include "data-generators/shepp_logan.h"
#include "data-generators/torso_ct.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <cmath>
#include <cstdint>
#include <exception>
#include <stdexcept>

vtkStandardNewMacro(vtkBrumePhantomSource);

vtkBrumePhantomSource::vtkBrumePhantomSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumePhantomSource::~vtkBrumePhantomSource() = default;

std::unique_ptr<brume::ExactField> vtkBrumePhantomSource::MakeField() const
{
  using namespace brume;
  const Box box{ glm::dvec3(-1.0), glm::dvec3(1.0) };
  const double d = this->Density;
  switch (this->Kind)
  {
    case KindConstant:
      return std::make_unique<ConstantField>(box, d);
    case KindRamp:
      return std::make_unique<RampField>(box, 0.5 * d, glm::dvec3(0.5 * d, 0.0, 0.0));
    case KindBall:
      return std::make_unique<BallField>(box, d, this->Radius, BallField::Profile::uniform);
    case KindSoftBall:
      return std::make_unique<BallField>(box, d, this->Radius, BallField::Profile::parabolic);
    case KindSlab:
      return std::make_unique<SlabField>(box,
        d,
        glm::dvec3(this->Normal[0], this->Normal[1], this->Normal[2]),
        0.0,
        this->Thickness);
    case KindChecker:
      return std::make_unique<CheckerField>(box, d, 0.0, glm::ivec3(this->Cells));
    default:
      return std::make_unique<SheppLogan>(
        this->RaisedContrast ? SheppLogan::Contrast::raised : SheppLogan::Contrast::kak_slaney);
  }
}

double vtkBrumePhantomSource::GetOpticalDepth(const double origin[3],
  const double direction[3],
  double from,
  double to)
{
  try
  {
    if (!this->IsScan())
    {
      return this->MakeField()->optical_depth({ origin[0], origin[1], origin[2] },
        { direction[0], direction[1], direction[2] },
        from,
        to);
    }
  }
  catch (const std::invalid_argument&)
  {
  }
  return vtkMath::Nan();
}

brume::Box vtkBrumePhantomSource::GetBox() const
{
  switch (this->Kind)
  {
    case KindHeadCT:
      return brume::head_ct_bounds();
    case KindTorsoCT:
      return brume::torso_ct_bounds();
    default:
      return { glm::dvec3(-1.0), glm::dvec3(1.0) };
  }
}

int vtkBrumePhantomSource::RequestInformation(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  brume::describe_grid(brume::grid_over(this->GetBox(), this->Size),
    this->IsScan() ? VTK_SHORT : VTK_FLOAT,
    outputs->GetInformationObject(0));
  return 1;
}

int vtkBrumePhantomSource::RequestData(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  vtkImageData* image = vtkImageData::GetData(info);
  const int* extent = info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT());
  try
  {
    if (!std::isfinite(this->EdgeWidth))
    {
      throw std::invalid_argument("EdgeWidth must be finite");
    }
    const brume::Lattice grid = brume::grid_over(this->GetBox(), this->Size);
    const auto seed = static_cast<std::uint32_t>(this->Seed);
    if (this->IsScan() && (!this->Scan || this->ScanTime != this->GetMTime()))
    {
      const double edge = this->EdgeWidth * grid.spacing.x;
      this->Scan = this->Kind == KindHeadCT ? brume::HeadCT({ seed, edge }).share_painting()
                                            : brume::TorsoCT({ seed, edge }).share_painting();
      this->ScanTime = this->GetMTime();
    }
    this->AllocateOutputData(image, info);
    image->GetPointData()->GetScalars()->SetName(this->IsScan() ? "Hounsfield" : "density");
    const brume::Extent block = brume::extent_of(image->GetExtent());
    void* values = block.voxels() > 0 ? image->GetScalarPointer() : nullptr;
    const brume::Progress progress = brume::progress_of(this);
    const bool whole = !values          ? true
                       : this->IsScan() ? brume::sample_scan(*this->Scan,
                                            this->NoiseLevel,
                                            seed,
                                            grid,
                                            block,
                                            static_cast<std::int16_t*>(values),
                                            progress)
                                        : brume::sample_means(*this->MakeField(),
                                            this->EdgeWidth,
                                            grid,
                                            block,
                                            static_cast<float*>(values),
                                            progress);
    if (!whole)
    {
      image->Initialize();
    }
  }
  catch (const std::exception& problem)
  {
    image->Initialize();
    vtkErrorMacro("the phantom could not be made for the extent "
                  << extent[0] << ' ' << extent[1] << ' ' << extent[2] << ' ' << extent[3] << ' '
                  << extent[4] << ' ' << extent[5] << ": " << problem.what());
    return 0;
  }
  return 1;
}

void vtkBrumePhantomSource::PrintSelf(ostream& os, vtkIndent indent)
{
  static const char* const kinds[] = {
    "HeadCT", "TorsoCT", "SheppLogan", "Constant", "Ramp", "Ball", "SoftBall", "Slab", "Checker"
  };
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Kind: " << kinds[this->Kind] << "\n";
  os << indent << "Size: " << this->Size << " voxels\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "NoiseLevel: " << this->NoiseLevel << " HU\n";
  os << indent << "EdgeWidth: " << this->EdgeWidth << " voxels\n";
  os << indent << "Density: " << this->Density << "\n";
  os << indent << "RaisedContrast: " << (this->RaisedContrast ? "On\n" : "Off\n");
  os << indent << "Radius: " << this->Radius << "\n";
  os << indent << "Thickness: " << this->Thickness << "\n";
  os << indent << "Normal: " << this->Normal[0] << " " << this->Normal[1] << " " << this->Normal[2]
     << "\n";
  os << indent << "Cells: " << this->Cells << "\n";
}
