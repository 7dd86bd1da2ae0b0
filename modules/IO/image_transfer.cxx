#include "image_transfer.h"

#include "vtkAbstractArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <string>

namespace brume::io
{

namespace
{

class Out
{
public:
  explicit Out(int file)
    : file_(file)
  {
  }
  bool good() const { return good_; }
  void bytes(const void* data, std::size_t count)
  {
    const char* from = static_cast<const char*>(data);
    while (good_ && count > 0)
    {
      const ssize_t n = ::write(file_, from, std::min<std::size_t>(count, 1 << 28));
      good_ = n > 0;
      from += n;
      count -= good_ ? static_cast<std::size_t>(n) : 0;
    }
  }
  template <class T>
  void number(T value)
  {
    bytes(&value, sizeof(value));
  }
  void text(const std::string& text)
  {
    number<std::uint64_t>(text.size());
    bytes(text.data(), text.size());
  }

private:
  int file_;
  bool good_ = true;
};

class In
{
public:
  explicit In(int file)
    : file_(file)
  {
  }
  bool good() const { return good_; }
  void bytes(void* data, std::size_t count)
  {
    char* to = static_cast<char*>(data);
    while (good_ && count > 0)
    {
      const ssize_t n = ::read(file_, to, std::min<std::size_t>(count, 1 << 28));
      good_ = n > 0;
      to += n;
      count -= good_ ? static_cast<std::size_t>(n) : 0;
    }
  }
  template <class T>
  T number()
  {
    T value{};
    bytes(&value, sizeof(value));
    return value;
  }
  std::string text()
  {
    const std::uint64_t size = number<std::uint64_t>();
    good_ = good_ && size < (1u << 20);
    std::string text(good_ ? size : 0, '\0');
    bytes(&text[0], text.size());
    return text;
  }

private:
  int file_;
  bool good_ = true;
};

void write_arrays(Out& out, vtkDataSetAttributes* data)
{
  std::vector<vtkDataArray*> arrays;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = data->GetArray(i);
    if (array && array->GetDataType() != VTK_BIT && array->HasStandardMemoryLayout())
    {
      arrays.push_back(array);
    }
  }
  out.number<std::int32_t>(static_cast<std::int32_t>(arrays.size()));
  for (vtkDataArray* array : arrays)
  {
    out.text(array->GetName() ? array->GetName() : "");
    out.number<std::int32_t>(array->GetDataType());
    out.number<std::int32_t>(array->GetNumberOfComponents());
    out.number<std::int64_t>(array->GetNumberOfTuples());
    out.number<std::int32_t>(array == data->GetScalars());
    out.bytes(array->GetVoidPointer(0),
      static_cast<std::size_t>(array->GetNumberOfValues()) * array->GetDataTypeSize());
  }
}

void read_arrays(In& in, vtkDataSetAttributes* data)
{
  const auto count = in.number<std::int32_t>();
  for (std::int32_t i = 0; i < count && in.good(); ++i)
  {
    const std::string name = in.text();
    const auto type = in.number<std::int32_t>();
    const auto components = in.number<std::int32_t>();
    const auto tuples = in.number<std::int64_t>();
    const auto scalars = in.number<std::int32_t>();
    if (!in.good())
    {
      return;
    }
    vtkSmartPointer<vtkDataArray> array;
    array.TakeReference(vtkDataArray::CreateDataArray(type));
    array->SetName(name.empty() ? nullptr : name.c_str());
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(tuples);
    in.bytes(array->GetVoidPointer(0),
      static_cast<std::size_t>(array->GetNumberOfValues()) * array->GetDataTypeSize());
    const int index = data->AddArray(array);
    if (scalars)
    {
      data->SetActiveAttribute(index, vtkDataSetAttributes::SCALARS);
    }
  }
}

}

bool write_image(int file, vtkImageData* image)
{
  Out out(file);
  out.bytes(image->GetExtent(), 6 * sizeof(int));
  out.bytes(image->GetSpacing(), 3 * sizeof(double));
  out.bytes(image->GetOrigin(), 3 * sizeof(double));
  out.bytes(image->GetDirectionMatrix()->GetData(), 9 * sizeof(double));
  write_arrays(out, image->GetPointData());
  write_arrays(out, image->GetCellData());
  vtkFieldData* fields = image->GetFieldData();
  std::vector<vtkStringArray*> texts;
  for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
  {
    auto* text = vtkStringArray::SafeDownCast(fields->GetAbstractArray(i));
    if (text && text->GetName() && text->GetNumberOfValues() == 1)
    {
      texts.push_back(text);
    }
  }
  out.number<std::int32_t>(static_cast<std::int32_t>(texts.size()));
  for (vtkStringArray* text : texts)
  {
    out.text(text->GetName());
    out.text(text->GetValue(0));
  }
  return out.good();
}

vtkSmartPointer<vtkImageData> read_image(int file)
{
  In in(file);
  auto image = vtkSmartPointer<vtkImageData>::New();
  int extent[6];
  double spacing[3], origin[3], direction[9];
  in.bytes(extent, sizeof(extent));
  in.bytes(spacing, sizeof(spacing));
  in.bytes(origin, sizeof(origin));
  in.bytes(direction, sizeof(direction));
  if (!in.good())
  {
    return nullptr;
  }
  image->SetExtent(extent);
  image->SetSpacing(spacing);
  image->SetOrigin(origin);
  image->SetDirectionMatrix(direction);
  read_arrays(in, image->GetPointData());
  read_arrays(in, image->GetCellData());
  const auto texts = in.number<std::int32_t>();
  for (std::int32_t i = 0; i < texts && in.good(); ++i)
  {
    vtkNew<vtkStringArray> text;
    text->SetName(in.text().c_str());
    text->InsertNextValue(in.text());
    image->GetFieldData()->AddArray(text);
  }
  return in.good() ? image : nullptr;
}

}
