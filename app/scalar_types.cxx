#include "scalar_types.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace brume::app
{

namespace
{

struct Type
{
  const char* name;
  int vtk;
};
constexpr Type Types[] = { { "uint8", VTK_UNSIGNED_CHAR },
  { "int8", VTK_SIGNED_CHAR },
  { "uint16", VTK_UNSIGNED_SHORT },
  { "int16", VTK_SHORT },
  { "uint32", VTK_UNSIGNED_INT },
  { "int32", VTK_INT },
  { "float", VTK_FLOAT },
  { "double", VTK_DOUBLE } };

/// What a conversion did to the values.
struct Losses
{
  std::uint64_t rounded = 0;
  std::uint64_t held = 0; ///< to the range
  std::uint64_t not_numbers = 0;
};

template <class In, class Out>
void convert(const In* in, Out* out, vtkIdType count, Losses& losses)
{
  for (vtkIdType i = 0; i < count; ++i)
  {
    if constexpr (std::is_integral_v<Out>)
    {
      const double value = static_cast<double>(in[i]);
      const double low = static_cast<double>(std::numeric_limits<Out>::lowest());
      const double high = static_cast<double>(std::numeric_limits<Out>::max());
      if (std::isnan(value))
      {
        ++losses.not_numbers;
        out[i] = 0;
        continue;
      }
      const double whole = std::round(value);
      const double held = std::clamp(whole, low, high);
      losses.held += held != whole;
      losses.rounded += held == whole && whole != value;
      out[i] = static_cast<Out>(held);
    }
    else
    {
      out[i] = static_cast<Out>(in[i]);
      losses.rounded += static_cast<double>(out[i]) != static_cast<double>(in[i]) &&
                        !std::isnan(static_cast<double>(in[i]));
    }
  }
}

template <class In>
void convert(const In* in, vtkDataArray* out, Losses& losses)
{
  switch (out->GetDataType())
  {
    vtkTemplateMacro(
      convert(in, static_cast<VTK_TT*>(out->GetVoidPointer(0)), out->GetNumberOfValues(), losses));
  }
}

}

const std::vector<std::string>& scalar_types()
{
  static const std::vector<std::string> names = []
  {
    std::vector<std::string> list;
    for (const Type& type : Types)
    {
      list.push_back(type.name);
    }
    return list;
  }();
  return names;
}

std::vector<std::string> convert_scalars(vtkImageData* image, const std::string& name)
{
  vtkDataArray* in = image->GetPointData()->GetScalars();
  const auto* type = std::find_if(
    std::begin(Types), std::end(Types), [&name](const Type& t) { return name == t.name; });
  if (type == std::end(Types) || in->GetDataType() == type->vtk)
  {
    return {};
  }
  vtkSmartPointer<vtkDataArray> out;
  out.TakeReference(vtkDataArray::CreateDataArray(type->vtk));
  out->SetName(in->GetName());
  out->SetNumberOfComponents(in->GetNumberOfComponents());
  out->SetNumberOfTuples(in->GetNumberOfTuples());
  Losses losses;
  switch (in->GetDataType())
  {
    vtkTemplateMacro(convert(static_cast<const VTK_TT*>(in->GetVoidPointer(0)), out, losses));
  }
  image->GetPointData()->SetScalars(out);
  std::vector<std::string> messages;
  const auto tell = [&](std::uint64_t count, const std::string& what)
  {
    if (count > 0)
    {
      messages.push_back(std::to_string(count) + " of " + std::to_string(out->GetNumberOfValues()) +
                         " values " + what);
    }
  };
  tell(losses.rounded, "are rounded to " + name);
  tell(losses.held, "are beyond " + name + " and are held to its range");
  tell(losses.not_numbers, "are not numbers, which " + name + " has none of, and become 0");
  return messages;
}

}
