#include "scan_values.h"

#include "dicom_decode.h"

#include "vtkDataArray.h"

#include <algorithm>
#include <cmath>

namespace brume::io
{

int vtk_type(Scalar scalar)
{
  switch (scalar)
  {
    case Scalar::Int8:
      return VTK_SIGNED_CHAR;
    case Scalar::UInt8:
      return VTK_UNSIGNED_CHAR;
    case Scalar::Int16:
      return VTK_SHORT;
    case Scalar::UInt16:
      return VTK_UNSIGNED_SHORT;
    case Scalar::Int32:
      return VTK_INT;
    case Scalar::UInt32:
      return VTK_UNSIGNED_INT;
    case Scalar::Int64:
      return VTK_TYPE_INT64;
    case Scalar::UInt64:
      return VTK_TYPE_UINT64;
    case Scalar::Float32:
      return VTK_FLOAT;
    case Scalar::Float64:
      return VTK_DOUBLE;
  }
  return VTK_VOID;
}

bool rescales(const ScanHeader& header)
{
  return header.slope != 1 || header.intercept != 0 || !header.part_rescale.empty();
}

int value_type(const ScanHeader& header)
{
  if (!rescales(header))
  {
    return vtk_type(header.scalar);
  }
  if (header.values_are_int16)
  {
    return VTK_SHORT;
  }
  const bool wide = scalar_size(header.scalar) >= 4 && header.scalar != Scalar::Float32;
  return wide ? VTK_DOUBLE : VTK_FLOAT;
}

double memory_need(const ScanHeader& header)
{
  const double stored = static_cast<double>(header.bytes());
  // Pictures are decoded in a process of its own and handed over.
  double need = header.encoding == Encoding::Pictures ? 2 * stored : stored;
  if ((header.planar || header.part_planar) && header.components > 1)
  {
    need = 2 * stored;
  }
  if (rescales(header))
  {
    const int type = value_type(header);
    const int size = type == VTK_SHORT ? 2 : type == VTK_FLOAT ? 4 : 8;
    need = std::max(need, stored + stored / scalar_size(header.scalar) * size);
  }
  if (header.encoding == Encoding::Dicom)
  {
    // All pictures of a file are decoded at once.
    const double slice = stored / std::max(static_cast<double>(header.dimensions[2]), 1.0);
    double largest = 0;
    for (const DataPart& part : header.parts)
    {
      largest = std::max(largest, slice * static_cast<double>(part.frames));
    }
    need = std::max(need, stored + decoding_need(largest));
  }
  return need;
}

namespace
{

template <typename In, typename Out>
void rescale(const In* in, Out* out, vtkIdType count, double slope, double intercept)
{
  for (vtkIdType i = 0; i < count; ++i)
  {
    out[i] = static_cast<Out>(slope * static_cast<double>(in[i]) + intercept);
  }
}

template <typename In>
void rescale(const In* in, short* out, vtkIdType count, double slope, double intercept)
{
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double value = std::round(slope * static_cast<double>(in[i]) + intercept);
    out[i] = static_cast<short>(std::min(32767.0, std::max(-32768.0, value)));
  }
}

template <typename In>
void rescale_part(const In* in, vtkDataArray* values, vtkIdType from, vtkIdType count, double slope,
  double intercept)
{
  void* out = values->GetVoidPointer(from);
  switch (values->GetDataType())
  {
    case VTK_SHORT:
      return rescale(in + from, static_cast<short*>(out), count, slope, intercept);
    case VTK_FLOAT:
      return rescale(in + from, static_cast<float*>(out), count, slope, intercept);
    default:
      return rescale(in + from, static_cast<double*>(out), count, slope, intercept);
  }
}

}

vtkSmartPointer<vtkDataArray> rescaled(vtkDataArray* stored, const ScanHeader& header)
{
  vtkSmartPointer<vtkDataArray> values;
  values.TakeReference(vtkDataArray::CreateDataArray(value_type(header)));
  values->SetNumberOfComponents(stored->GetNumberOfComponents());
  values->SetNumberOfTuples(stored->GetNumberOfTuples());
  const vtkIdType parts =
    std::max<vtkIdType>(static_cast<vtkIdType>(header.part_rescale.size()), 1);
  const vtkIdType each = stored->GetNumberOfValues() / parts;
  for (vtkIdType part = 0; part < parts; ++part)
  {
    double slope = header.slope;
    double intercept = header.intercept;
    if (!header.part_rescale.empty())
    {
      slope = header.part_rescale[part][0];
      intercept = header.part_rescale[part][1];
    }
    switch (stored->GetDataType())
    {
      vtkTemplateMacro(rescale_part(static_cast<const VTK_TT*>(stored->GetVoidPointer(0)), values,
        part * each, each, slope, intercept));
    }
  }
  return values;
}

}
