#include "study_chart.h"

#include "canvas.h"
#include "figures.h"
#include "study_words.h"

#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotLine.h>
#include <vtkPlotPoints.h>
#include <vtkPointData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace brume
{

namespace
{

/// Drawn larger and shrunk, which smooths the edges.
constexpr int oversampling = 2;
constexpr int letters = 17; ///< pixels of the finished picture
constexpr Colour ink{ 28, 31, 36 };
constexpr Colour faint{ 120, 128, 138 };
constexpr Colour paper{ 255, 255, 255 };

/// Colours that colour-blind eyes tell apart (Okabe and Ito 2008).
const std::array<Colour, 9>& colours()
{
  static const std::array<Colour, 9> list{ { { 0, 114, 178 }, { 230, 159, 0 }, { 0, 158, 115 },
    { 204, 121, 167 }, { 86, 180, 233 }, { 213, 94, 0 }, { 140, 130, 20 }, { 110, 110, 110 },
    { 95, 60, 160 } } };
  return list;
}

struct Spot
{
  double x = 0.0; ///< log10 of seconds
  double y = 0.0; ///< log10 of the error in 1/255
  const StudyPoint* point = nullptr;
};

std::vector<Spot> spots_of(const Study& study)
{
  std::vector<Spot> spots;
  for (const StudyPoint& point : study.points)
  {
    const double error = point.errors.rms_limited ? point.errors.rms_upper : point.errors.rms;
    const double seconds = point.timing.median;
    if (point.skipped.empty() && error > 0.0 && std::isfinite(error) && seconds > 0.0)
    {
      spots.push_back({ std::log10(seconds), std::log10(255.0 * error), &point });
    }
  }
  return spots;
}

/// Decades as ticks, and the range that holds all values with some air.
struct Scale
{
  double lower = 0.0;
  double upper = 1.0;

  void hold(double value, bool first)
  {
    this->lower = first ? value : std::min(this->lower, value);
    this->upper = first ? value : std::max(this->upper, value);
  }
  void widen()
  {
    const double air = std::max(0.1, 0.06 * (this->upper - this->lower));
    this->lower -= air;
    this->upper += air;
  }
};

void set_axis(vtkAxis* axis, const Scale& scale, const std::string& title)
{
  vtkNew<vtkDoubleArray> places;
  vtkNew<vtkStringArray> texts;
  // 1, 2 and 5 of each decade where there are few of them.
  const bool fine = scale.upper - scale.lower < 2.5;
  for (int decade = static_cast<int>(std::floor(scale.lower)); decade <= std::ceil(scale.upper); ++decade)
  {
    for (const double digit : { 1.0, 2.0, 5.0 })
    {
      const double place = decade + std::log10(digit);
      if ((digit == 1.0 || fine) && place >= scale.lower && place <= scale.upper)
      {
        places->InsertNextValue(place);
        texts->InsertNextValue(figure(std::pow(10.0, place)));
      }
    }
  }
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetRange(scale.lower, scale.upper);
  axis->SetCustomTickPositions(places, texts);
  axis->SetTitle(title);
  axis->GetTitleProperties()->SetFontSize(oversampling * letters);
  axis->GetTitleProperties()->SetBold(0);
  axis->GetTitleProperties()->SetColor(ink[0] / 255.0, ink[1] / 255.0, ink[2] / 255.0);
  axis->GetLabelProperties()->SetFontSize(oversampling * letters);
  axis->GetLabelProperties()->SetColor(ink[0] / 255.0, ink[1] / 255.0, ink[2] / 255.0);
  axis->GetGridPen()->SetColor(225, 228, 232, 255);
  axis->GetGridPen()->SetWidth(oversampling);
  axis->GetPen()->SetWidth(oversampling);
}

vtkSmartPointer<vtkTable> table_of(const std::vector<Spot>& spots)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  vtkNew<vtkFloatArray> x;
  vtkNew<vtkFloatArray> y;
  x->SetName("seconds");
  y->SetName("error");
  for (const Spot& spot : spots)
  {
    x->InsertNextValue(static_cast<float>(spot.x));
    y->InsertNextValue(static_cast<float>(spot.y));
  }
  table->AddColumn(x);
  table->AddColumn(y);
  return table;
}

void add_knobs(vtkChartXY* chart, const Study& study, const std::vector<Spot>& spots)
{
  static constexpr int shapes[] = { vtkPlotPoints::CIRCLE, vtkPlotPoints::SQUARE, vtkPlotPoints::DIAMOND };
  std::size_t index = 0;
  for (const StudyKnob& knob : study.knobs)
  {
    std::vector<Spot> of_knob;
    std::copy_if(spots.begin(), spots.end(), std::back_inserter(of_knob),
      [&](const Spot& s) { return s.point->knob == knob.name; });
    if (of_knob.empty())
    {
      continue;
    }
    const bool stock = of_knob.front().point->stock;
    const Colour colour = stock ? ink : colours()[index % colours().size()];
    auto* plot = vtkPlotPoints::SafeDownCast(chart->AddPlot(vtkChart::POINTS));
    plot->SetInputData(table_of(of_knob), 0, 1);
    plot->SetColor(colour[0], colour[1], colour[2], 255);
    plot->SetMarkerStyle(stock ? vtkPlotPoints::CROSS : shapes[index % 3]);
    plot->SetMarkerSize(oversampling * 10.0f);
    plot->SetLabel(stock ? "VTK's own mappers" : knob.title);
    index += stock ? 0 : 1;
  }
}

/// The front as steps would lie about settings between; a line says what lies nearest.
void add_front(vtkChartXY* chart, const std::vector<Spot>& spots)
{
  std::vector<Spot> front;
  std::copy_if(spots.begin(), spots.end(), std::back_inserter(front),
    [](const Spot& s) { return s.point->on_front; });
  std::sort(front.begin(), front.end(), [](const Spot& a, const Spot& b) { return a.x < b.x; });
  if (front.size() < 2)
  {
    return;
  }
  vtkPlot* line = chart->AddPlot(vtkChart::LINE);
  line->SetInputData(table_of(front), 0, 1);
  line->SetColor(ink[0], ink[1], ink[2], 255);
  line->SetWidth(oversampling * 2.0f);
  line->SetLabel("beaten by none");
}

struct Box
{
  int left, top, right, bottom;
  bool meets(const Box& o) const
  {
    return this->left < o.right && o.left < this->right && this->top < o.bottom && o.top < this->bottom;
  }
};

/// Where the chart's plot lies in the finished picture, from its upper left corner.
struct Frame
{
  Box box;
  Scale across;
  Scale up;

  int x(double value) const
  {
    const double part = (value - this->across.lower) / (this->across.upper - this->across.lower);
    return this->box.left + static_cast<int>(std::lround(part * (this->box.right - this->box.left)));
  }
  int y(double value) const
  {
    const double part = (value - this->up.lower) / (this->up.upper - this->up.lower);
    return this->box.bottom - static_cast<int>(std::lround(part * (this->box.bottom - this->box.top)));
  }
};

/// Whether the line from a to b passes through the box.
bool crosses(const Box& box, double ax, double ay, double bx, double by)
{
  constexpr int pieces = 60;
  for (int i = 0; i <= pieces; ++i)
  {
    const double t = static_cast<double>(i) / pieces;
    const double x = ax + t * (bx - ax);
    const double y = ay + t * (by - ay);
    if (x >= box.left && x <= box.right && y >= box.top && y <= box.bottom)
    {
      return true;
    }
  }
  return false;
}

/// Names the front's settings beside their marks, as far as they find room: the ends of the front first.
void name_front(Canvas& canvas, const Frame& frame, const std::vector<Spot>& spots, const Study& study)
{
  constexpr int mark = 7;
  std::vector<Spot> front;
  std::vector<Box> taken;
  for (const Spot& spot : spots)
  {
    const int x = frame.x(spot.x);
    const int y = frame.y(spot.y);
    taken.push_back({ x - mark, y - mark, x + mark, y + mark });
    if (spot.point->on_front)
    {
      front.push_back(spot);
    }
  }
  std::sort(front.begin(), front.end(), [](const Spot& a, const Spot& b) { return a.x < b.x; });
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < front.size(); ++i)
  {
    order.push_back(i % 2 ? i / 2 : front.size() - 1 - i / 2); // from both ends inward
  }
  const TextStyle style{ letters - 2, false, ink };
  for (const std::size_t i : order)
  {
    const std::string name = point_name(study, *front[i].point);
    const int width = text_width(name, style);
    const int x = frame.x(front[i].x);
    const int y = frame.y(front[i].y);
    const int gap = mark + 4;
    const int half = letters / 2;
    const std::array<std::array<int, 2>, 6> places{ { { x + gap, y - half }, { x - gap - width, y - half },
      { x + gap, y - letters - gap / 2 }, { x - gap - width, y + gap / 2 }, { x - width / 2, y - gap - letters },
      { x - width / 2, y + gap } } };
    for (const auto& place : places)
    {
      const Box box{ place[0] - 3, place[1], place[0] + width + 3, place[1] + letters };
      bool free = box.left >= frame.box.left && box.right <= frame.box.right &&
        box.top >= frame.box.top && box.bottom <= frame.box.bottom;
      for (const Box& other : taken)
      {
        free = free && !box.meets(other);
      }
      for (std::size_t k = 0; k + 1 < front.size() && free; ++k)
      {
        free = !crosses(box, frame.x(front[k].x), frame.y(front[k].y), frame.x(front[k + 1].x),
          frame.y(front[k + 1].y));
      }
      if (free)
      {
        canvas.text(place[0], place[1] + letters - 3, name, style);
        taken.push_back(box);
        break;
      }
    }
  }
}

/// What the window shows, R, G, B from the bottom up.
Bitmap grab(vtkRenderWindow* window)
{
  vtkNew<vtkWindowToImageFilter> filter;
  filter->SetInput(window);
  filter->SetInputBufferTypeToRGB();
  filter->ReadFrontBufferOff();
  filter->Update();
  vtkImageData* image = filter->GetOutput();
  auto* bytes = vtkUnsignedCharArray::SafeDownCast(image->GetPointData()->GetScalars());
  const int* size = image->GetDimensions();
  if (!bytes || bytes->GetNumberOfValues() != 3LL * size[0] * size[1])
  {
    throw std::runtime_error("chart: the window cannot be read: see that OpenGL works");
  }
  Bitmap bitmap{ size[0], size[1], {} };
  bitmap.rgb.assign(bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
  return bitmap;
}

}

Bitmap study_chart(const Study& study, int width, int height)
{
  if (width < 400 || height < 300)
  {
    throw std::invalid_argument("chart: it is too small: give it 400 x 300 pixels or more");
  }
  const std::vector<Spot> spots = spots_of(study);
  Frame frame{};
  for (std::size_t i = 0; i < spots.size(); ++i)
  {
    frame.across.hold(spots[i].x, i == 0);
    frame.up.hold(spots[i].y, i == 0);
  }
  frame.across.widen();
  frame.up.widen();

  constexpr int heading = 60;
  const int below = height - heading;
  vtkNew<vtkChartXY> chart;
  set_axis(chart->GetAxis(vtkAxis::BOTTOM), frame.across, "seconds a picture");
  set_axis(chart->GetAxis(vtkAxis::LEFT), frame.up, "RMS error, 1/255 of white");
  add_front(chart, spots);
  add_knobs(chart, study, spots);
  chart->SetShowLegend(true);
  chart->GetLegend()->SetInline(false);
  chart->GetLegend()->SetHorizontalAlignment(vtkChartLegend::RIGHT);
  chart->GetLegend()->SetVerticalAlignment(vtkChartLegend::TOP);
  chart->GetLegend()->SetLabelSize(oversampling * letters);
  chart->GetLegend()->SetSymbolWidth(oversampling * 22);
  chart->GetLegend()->SetPadding(oversampling * 5);

  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1.0, 1.0, 1.0);
  vtkNew<vtkContextActor> actor;
  actor->GetScene()->AddItem(chart);
  actor->GetScene()->SetRenderer(renderer);
  renderer->AddActor(actor);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(oversampling * width, oversampling * below);
  window->AddRenderer(renderer);
  window->Render();

  Canvas canvas(width, height, paper);
  canvas.draw(grab(window), 0, heading, width, below);
  const int* low = chart->GetPoint1();
  const int* high = chart->GetPoint2();
  frame.box = { low[0] / oversampling, height - high[1] / oversampling, high[0] / oversampling,
    height - low[1] / oversampling };
  const TextStyle title{ letters + 4, true, ink };
  const TextStyle subtitle{ letters - 2, false, faint };
  canvas.text(16, 27, fitted("What accuracy costs in time: " + study.scene.input, title, width - 32), title);
  canvas.text(16, 50,
    fitted(std::to_string(study.scene.width) + " x " + std::to_string(study.scene.height) +
        " pixels; truth: " +
        (study.truth.kind == "paths"
            ? "path traced, " + std::to_string(study.truth.samples_per_pixel) + " paths a pixel, its noise taken out"
            : study.truth.kind == "march" ? std::string("single scattering, refined")
                                          : std::string("quadrature in double precision")) +
        "; a mark is a setting",
      subtitle, width - 32),
    subtitle);
  name_front(canvas, frame, spots, study);
  return canvas.bitmap();
}

}
