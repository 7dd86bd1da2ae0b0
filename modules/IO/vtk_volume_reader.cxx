#include "vtk_volume_reader.h"

#include "file_access.h"
#include "guarded_process.h"
#include "header_text.h"
#include "image_transfer.h"
#include "memory_limit.h"

#include "vtkAlgorithm.h"
#include "vtkBitArray.h"
#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationInformationVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkLogger.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStructuredPoints.h"
#include "vtkStructuredPointsReader.h"
#include "vtkXMLImageDataReader.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <new>

namespace brume::io
{

namespace
{

const char* const Remedy = "check that the file is whole, or write it again";

/// Keeps what a VTK reader reports from the standard error stream, and remembers the first line.
class Listener
{
public:
  explicit Listener(Progress progress)
    : progress_(std::move(progress))
  {
    command_->SetClientData(this);
    command_->SetCallback(&Listener::hear);
  }
  void listen(vtkAlgorithm* reader)
  {
    for (vtkObject* object : { static_cast<vtkObject*>(reader),
           static_cast<vtkObject*>(reader->GetExecutive()) })
    {
      object->AddObserver(vtkCommand::ErrorEvent, command_);
      object->AddObserver(vtkCommand::WarningEvent, command_);
    }
    reader->AddObserver(vtkCommand::ProgressEvent, command_);
  }
  vtkCommand* command() { return command_; }
  bool stopped() const { return stopped_; }
  /// The first error's own words; empty when there was none.
  const std::string& error() const { return error_; }

private:
  static void hear(vtkObject* caller, unsigned long event, void* self, void* data)
  {
    Listener& listener = *static_cast<Listener*>(self);
    vtkAlgorithm* reader = vtkAlgorithm::SafeDownCast(caller);
    if (event == vtkCommand::ErrorEvent && listener.error_.empty())
    {
      // "ERROR: In FILE, line N\nvtkClass (0x…): words\n\n"
      std::string text = data ? static_cast<const char*>(data) : "";
      const std::size_t end_of_place = text.find("): ");
      text = end_of_place == std::string::npos ? text : text.substr(end_of_place + 3);
      std::replace(text.begin(), text.end(), '\n', ' ');
      listener.error_ = trimmed(text);
      if (listener.error_.empty())
      {
        listener.error_ = "unnamed error";
      }
    }
    else if (event == vtkCommand::ProgressEvent && reader && listener.progress_ &&
      !listener.progress_(reader->GetProgress()))
    {
      listener.stopped_ = true;
      reader->SetAbortExecute(1);
    }
  }

  Progress progress_;
  std::string error_;
  bool stopped_ = false;
  vtkNew<vtkCallbackCommand> command_;
};

/// Takes, while it lives, the place of VTK's window of messages: helper objects of VTK's readers
/// (vtkXMLDataElement) report errors on themselves, where no observer of the reader hears them.
class MessageTrap
{
public:
  MessageTrap()
    : before_(vtkOutputWindow::GetInstance())
    , verbosity_(vtkLogger::GetCurrentVerbosityCutoff())
  {
    vtkNew<Window> window;
    window->trap = this;
    vtkOutputWindow::SetInstance(window);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~MessageTrap()
  {
    vtkLogger::SetStderrVerbosity(verbosity_);
    vtkOutputWindow::SetInstance(before_);
  }
  MessageTrap(const MessageTrap&) = delete;
  MessageTrap& operator=(const MessageTrap&) = delete;
  bool error() const { return error_; }

private:
  class Window : public vtkOutputWindow
  {
  public:
    static Window* New() { VTK_STANDARD_NEW_BODY(Window); }
    void DisplayText(const char*) override {}
    void DisplayErrorText(const char*) override { trap->error_ = true; }
    void DisplayWarningText(const char*) override {}
    void DisplayGenericWarningText(const char*) override {}
    void DisplayDebugText(const char*) override {}
    MessageTrap* trap = nullptr;
  };

  vtkSmartPointer<vtkOutputWindow> before_;
  vtkLogger::Verbosity verbosity_;
  bool error_ = false;
};

/// Voxels of an extent, or −1 for one that is empty or that no image can have.
double voxels_of(const int extent[6])
{
  double voxels = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double n = static_cast<double>(extent[2 * axis + 1]) - extent[2 * axis] + 1;
    if (n < 1 || n > std::numeric_limits<int>::max())
    {
      return -1;
    }
    voxels *= n;
  }
  return voxels;
}

void check_promise(const std::string& path, double promised, double available)
{
  if (promised > available)
  {
    fail(path, "the file is cut short, or its header is wrong: it promises more voxels than the file "
               "has room for", "copy or download it again");
  }
}

/// Checks that an image carries numbers on its points, as many as there are points, and takes the
/// first such array as its scalars when none is marked.
void settle_scalars(VtkVolume& volume, const std::string& path)
{
  vtkImageData* image = volume.image;
  vtkPointData* points = image->GetPointData();
  vtkDataArray* scalars = points->GetScalars();
  for (int i = 0; !scalars && i < points->GetNumberOfArrays(); ++i)
  {
    scalars = points->GetArray(i);
    if (scalars && scalars->GetName())
    {
      points->SetActiveScalars(scalars->GetName());
      if (points->GetNumberOfArrays() > 1)
      {
        volume.messages.push_back(
          std::string("no array is marked as scalars; \"") + scalars->GetName() + "\" is taken");
      }
    }
    else if (scalars)
    {
      points->SetScalars(scalars);
    }
  }
  if (!scalars)
  {
    const bool cells = image->GetCellData()->GetNumberOfArrays() > 0;
    fail(path, cells ? "holds numbers in its cells only" : "holds no numbers",
      cells ? "convert them to point data (vtkCellDataToPointData)" : Remedy);
  }
  if (vtkBitArray::SafeDownCast(scalars))
  {
    fail(path, "its scalars are single bits", "save them as unsigned char");
  }
  if (scalars->GetNumberOfTuples() != image->GetNumberOfPoints() ||
    image->GetNumberOfPoints() < 1 || scalars->GetNumberOfComponents() < 1)
  {
    fail(path, "holds " + std::to_string(scalars->GetNumberOfTuples()) + " values for " +
        std::to_string(image->GetNumberOfPoints()) + " points", Remedy);
  }
}

/// What all arrays of an image of so many points take, in bytes, by what the reader says of them.
double memory_of(vtkInformation* info, double voxels)
{
  double bytes = 0;
  for (vtkInformationInformationVectorKey* key :
    { vtkDataObject::POINT_DATA_VECTOR(), vtkDataObject::CELL_DATA_VECTOR() })
  {
    vtkInformationVector* arrays = info->Get(key);
    for (int i = 0; arrays && i < arrays->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* array = arrays->GetInformationObject(i);
      const int components = array->Has(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS())
        ? array->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS())
        : 1;
      const int size = array->Has(vtkDataObject::FIELD_ARRAY_TYPE())
        ? vtkDataArray::GetDataTypeSize(array->Get(vtkDataObject::FIELD_ARRAY_TYPE()))
        : 8;
      bytes += voxels * std::max(components, 1) * std::max(size, 1);
    }
  }
  return std::max(bytes, voxels);
}

std::string read_range(const std::string& path, std::uint64_t from, std::size_t count)
{
  std::string text(count, '\0');
  ByteStream stream(path, path, from, ByteStream::Plain);
  text.resize(stream.read(&text[0], count));
  return text;
}

void stop_on_error(const std::string& path, const Listener& listener, const MessageTrap& trap)
{
  if (listener.stopped())
  {
    fail(path, "reading was interrupted", "run it again");
  }
  if (!listener.error().empty())
  {
    fail(path, "VTK cannot read it (" + listener.error() + ")", Remedy);
  }
  if (trap.error())
  {
    fail(path, "VTK cannot read it (its XML is not what the format asks for)", Remedy);
  }
}

VtkVolume read_vti_here(const std::string& path, std::uint64_t limit, const Progress& progress)
{
  const std::uint64_t length = file_length(path, path);
  const std::string head = read_range(path, 0, 1 << 16);
  const std::uint64_t tail_from = length > 256 ? length - 256 : 0;
  const std::string tail = trimmed(read_range(path, tail_from, 256));
  const std::size_t root = head.find("<VTKFile");
  const std::size_t root_end = head.find('>', root);
  const std::string opening =
    root == std::string::npos ? std::string() : head.substr(root, root_end - root);
  if (opening.find("ImageData") == std::string::npos ||
    opening.find("PImageData") != std::string::npos)
  {
    fail(path, "is a VTK XML file, but of no image data", "save the volume as vtkImageData (.vti)");
  }
  const std::string closing = "</VTKFile>";
  if (tail.size() < closing.size() ||
    tail.compare(tail.size() - closing.size(), closing.size(), closing) != 0)
  {
    fail(path, "the file is cut short: it does not end with </VTKFile>", "copy or download it again");
  }

  MessageTrap trap;
  Listener listener(progress);
  vtkNew<vtkXMLImageDataReader> reader;
  listener.listen(reader);
  reader->SetReaderErrorObserver(listener.command());
  reader->SetParserErrorObserver(listener.command());
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  stop_on_error(path, listener, trap);

  vtkInformation* info = reader->GetOutputInformation(0);
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  if (info->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
  {
    info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
  }
  const double voxels = voxels_of(extent);
  if (voxels < 0)
  {
    fail(path, "its extent holds no voxels", Remedy);
  }
  // What a byte of file can hold at most: text (a double in two), deflate, LZMA.
  const bool lzma = opening.find("LZMA") != std::string::npos;
  const bool packed = opening.find("compressor") != std::string::npos;
  check_promise(path, voxels, static_cast<double>(length) * (lzma ? 10000 : packed ? 1100 : 8));

  check_memory(path, 2 * memory_of(info, voxels), limit); // here, and where they are handed to

  reader->Update();
  stop_on_error(path, listener, trap);
  VtkVolume volume;
  volume.image = reader->GetOutput();
  settle_scalars(volume, path);
  return volume;
}

VtkVolume read_legacy_here(const std::string& path, const Progress& progress)
{
  MessageTrap trap;
  Listener listener(progress);
  vtkNew<vtkStructuredPointsReader> reader;
  listener.listen(reader);
  reader->SetFileName(path.c_str());
  reader->Update();
  stop_on_error(path, listener, trap);
  VtkVolume volume;
  volume.image = vtkSmartPointer<vtkImageData>::New();
  volume.image->ShallowCopy(reader->GetOutput());
  settle_scalars(volume, path);
  return volume;
}

/// Reads in a process of its own: VTK's readers believe the sizes of blocks and arrays that a file
/// gives, which a damaged one turns into endless loops, memory without bounds and crashes.
VtkVolume read_guarded(const std::string& path, std::uint64_t limit, const Progress& progress,
  const std::function<VtkVolume(const Progress&)>& read)
{
  const double length = static_cast<double>(file_length(path, path));
  const int file = memfd_create("brume", MFD_CLOEXEC);
  if (file < 0)
  {
    throw std::bad_alloc();
  }
  const SharedMemory page(sizeof(double));
  double* const done = static_cast<double*>(page.data());
  enum Status
  {
    Whole,
    Refused,
    NoMemory
  };
  const auto say = [file](const std::string& text)
  { return write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()); };
  const auto work = [&]() -> int
  {
    if (ftruncate(file, 0) != 0 || lseek(file, 0, SEEK_SET) != 0) // it may be tried twice
    {
      return NoMemory;
    }
    try
    {
      const VtkVolume volume = read(
        [done](double part)
        {
          *done = part;
          return true;
        });
      return write_image(file, volume.image) ? Whole : NoMemory;
    }
    catch (const std::bad_alloc&)
    {
      return NoMemory;
    }
    catch (const std::exception& error)
    {
      return say(error.what()) ? Refused : NoMemory;
    }
  };
  // A second and as long as a slow disk and a text of numbers take.
  const GuardResult result = run_guarded(work, 1 + length / 5e6,
    1.25 * static_cast<double>(memory_limit(limit)) + (64 << 20), progress, done);
  VtkVolume volume;
  std::string words;
  bool no_memory = result.status == NoMemory;
  if (result.end == GuardEnd::Finished && lseek(file, 0, SEEK_SET) == 0)
  {
    try
    {
      if (result.status == Whole)
      {
        volume.image = read_image(file);
      }
      else if (result.status == Refused)
      {
        char text[4096];
        const ssize_t n = ::read(file, text, sizeof(text));
        words.assign(text, n > 0 ? static_cast<std::size_t>(n) : 0);
      }
    }
    catch (const std::bad_alloc&)
    {
      no_memory = true;
    }
  }
  close(file);
  if (result.end != GuardEnd::Finished)
  {
    fail(path, spoken_end(result.end), result.end == GuardEnd::Stopped ? "run it again" : Remedy);
  }
  if (no_memory)
  {
    throw std::bad_alloc();
  }
  if (!volume.image)
  {
    // Brume's own errors name the file; what else comes out of VTK's readers speaks of containers.
    throw std::runtime_error(
      words.compare(0, path.size(), path) == 0 ? words : path + ": VTK cannot read it: " + Remedy);
  }
  settle_scalars(volume, path); // again, for its messages
  return volume;
}

}

VtkVolume read_vti(const std::string& path, std::uint64_t limit, const Progress& progress)
{
  VtkVolume volume = read_guarded(path, limit, progress,
    [&](const Progress& report) { return read_vti_here(path, limit, report); });
  volume.format = "VTK XML image data";
  const auto told = [&volume](const char* name)
  {
    auto* text =
      vtkStringArray::SafeDownCast(volume.image->GetFieldData()->GetAbstractArray(name));
    return text && text->GetNumberOfValues() == 1 ? std::string(text->GetValue(0)) : std::string();
  };
  volume.length_unit = told("length_unit");
  volume.value_unit = told("value_unit");
  volume.patient_axes = told("axes") == "RAS";
  return volume;
}

VtkVolume read_legacy(const std::string& path, std::uint64_t limit, const Progress& progress)
{
  VtkVolume volume = read_guarded(
    path, limit, progress, [&](const Progress& report) { return read_legacy_here(path, report); });
  volume.format = "legacy VTK";
  return volume;
}

}
