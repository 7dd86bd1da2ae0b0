#include "vtkBrumeFieldSource.h"

#include "vtkBrumeSourceTools.h"

vtkBrumeFieldSource::vtkBrumeFieldSource() = default;

vtkBrumeFieldSource::~vtkBrumeFieldSource() = default;

void vtkBrumeFieldSource::DescribeTime(vtkInformation* info)
{
  brume::describe_time(this->StartTime, this->EndTime, this->NumberOfTimeSteps, info);
}

double vtkBrumeFieldSource::GetMoment(vtkInformation* info)
{
  return brume::requested_time(info, this->Time);
}

void vtkBrumeFieldSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Time: " << this->Time << " s\n";
  os << indent << "StartTime: " << this->StartTime << " s\n";
  os << indent << "EndTime: " << this->EndTime << " s\n";
  os << indent << "NumberOfTimeSteps: " << this->NumberOfTimeSteps << "\n";
}
