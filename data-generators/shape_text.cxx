#include "data-generators/shape_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace brume
{

namespace
{

using glm::dvec3;
using Numbers = std::vector<double>;
using Parts = std::vector<Shape>;

/// What a list may be: how many numbers and shapes it takes, and what it makes of them.
struct Word
{
  const char* name;
  const char* usage;
  std::vector<std::size_t> numbers; ///< each count that is allowed
  std::size_t least_parts, most_parts;
  Shape (*make)(const Numbers&, const Parts&);
};

constexpr std::size_t any = static_cast<std::size_t>(-1);

/// Of several shapes, one after the other with what is there already.
template <typename Two>
Shape fold(const Parts& parts, Two two)
{
  Shape all = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i)
  {
    all = two(all, parts[i]);
  }
  return all;
}

/// A number that must be whole; no seed and no count is larger.
int whole(double x)
{
  if (!(x >= 0.0 && x <= 2147483647.0) || x != std::floor(x))
  {
    throw std::invalid_argument("counts and seeds are whole numbers, not below 0");
  }
  return static_cast<int>(x);
}

const std::vector<Word>& words()
{
  using namespace shapes;
  using N = const Numbers&;
  using P = const Parts&;
  static const std::vector<Word> table{
    { "sphere", "(sphere RADIUS)", { 1 }, 0, 0, [](N n, P) { return sphere(n[0]); } },
    { "box",
      "(box HALF_X HALF_Y HALF_Z [ROUNDING])",
      { 3, 4 },
      0,
      0,
      [](N n, P) {
        return box({ n[0], n[1], n[2] }, n.size() > 3 ? n[3] : 0.0);
      } },
    { "torus", "(torus RING TUBE)", { 2 }, 0, 0, [](N n, P) { return torus(n[0], n[1]); } },
    { "capsule",
      "(capsule AX AY AZ BX BY BZ RADIUS)",
      { 7 },
      0,
      0,
      [](N n, P) {
        return capsule({ n[0], n[1], n[2] }, { n[3], n[4], n[5] }, n[6]);
      } },
    { "cylinder",
      "(cylinder RADIUS HALF_HEIGHT)",
      { 2 },
      0,
      0,
      [](N n, P) { return cylinder(n[0], n[1]); } },
    { "cone",
      "(cone BOTTOM TOP HALF_HEIGHT)",
      { 3 },
      0,
      0,
      [](N n, P) { return cone(n[0], n[1], n[2]); } },
    { "ellipsoid",
      "(ellipsoid RX RY RZ)",
      { 3 },
      0,
      0,
      [](N n, P) {
        return ellipsoid({ n[0], n[1], n[2] });
      } },
    { "plane",
      "(plane NX NY NZ OFFSET)",
      { 4 },
      0,
      0,
      [](N n, P) {
        return plane({ n[0], n[1], n[2] }, n[3]);
      } },
    { "unite", "(unite SHAPE...)", { 0 }, 1, any, [](N, P p) { return unite(p); } },
    { "intersect", "(intersect SHAPE...)", { 0 }, 1, any, [](N, P p) { return intersect(p); } },
    { "subtract",
      "(subtract SHAPE SHAPE...)",
      { 0 },
      2,
      any,
      [](N, P p)
      { return fold(p, [](const Shape& a, const Shape& b) { return subtract(a, b); }); } },
    { "complement", "(complement SHAPE)", { 0 }, 1, 1, [](N, P p) { return complement(p[0]); } },
    { "smooth-unite",
      "(smooth-unite WIDTH SHAPE SHAPE...)",
      { 1 },
      2,
      any,
      [](N n, P p) {
        return fold(p, [&](const Shape& a, const Shape& b) { return smooth_unite(a, b, n[0]); });
      } },
    { "smooth-intersect",
      "(smooth-intersect WIDTH SHAPE SHAPE...)",
      { 1 },
      2,
      any,
      [](N n, P p) {
        return fold(
          p, [&](const Shape& a, const Shape& b) { return smooth_intersect(a, b, n[0]); });
      } },
    { "smooth-subtract",
      "(smooth-subtract WIDTH SHAPE SHAPE...)",
      { 1 },
      2,
      any,
      [](N n, P p) {
        return fold(p, [&](const Shape& a, const Shape& b) { return smooth_subtract(a, b, n[0]); });
      } },
    { "move",
      "(move X Y Z SHAPE)",
      { 3 },
      1,
      1,
      [](N n, P p) {
        return moved(p[0], { n[0], n[1], n[2] });
      } },
    { "rotate",
      "(rotate AXIS_X AXIS_Y AXIS_Z DEGREES SHAPE)",
      { 4 },
      1,
      1,
      [](N n, P p) {
        return rotated(p[0], { n[0], n[1], n[2] }, n[3]);
      } },
    { "scale", "(scale FACTOR SHAPE)", { 1 }, 1, 1, [](N n, P p) { return scaled(p[0], n[0]); } },
    { "twist",
      "(twist DEGREES_A_UNIT SHAPE)",
      { 1 },
      1,
      1,
      [](N n, P p) { return twisted(p[0], n[0]); } },
    { "repeat",
      "(repeat SX SY SZ [NX NY NZ] SHAPE)",
      { 3, 6 },
      1,
      1,
      [](N n, P p)
      {
        const dvec3 spacing(n[0], n[1], n[2]);
        return n.size() == 3 ? repeated(p[0], spacing)
                             : repeated(p[0], spacing, { whole(n[3]), whole(n[4]), whole(n[5]) });
      } },
    { "waves",
      "(waves AMPLITUDE WAVELENGTH SHAPE)",
      { 2 },
      1,
      1,
      [](N n, P p) { return displaced_by_waves(p[0], n[0], n[1]); } },
    { "noise",
      "(noise AMPLITUDE SIZE SEED SHAPE)",
      { 3 },
      1,
      1,
      [](N n, P p)
      { return displaced_by_noise(p[0], n[0], n[1], static_cast<std::uint32_t>(whole(n[2]))); } },
    { "grow", "(grow RADIUS SHAPE)", { 1 }, 1, 1, [](N n, P p) { return grown(p[0], n[0]); } },
    { "shell", "(shell THICKNESS SHAPE)", { 1 }, 1, 1, [](N n, P p) { return shell(p[0], n[0]); } },
  };
  return table;
}

class Reader
{
public:
  explicit Reader(const std::string& text)
    : m_text(text)
  {
  }

  Shape read()
  {
    this->skip();
    if (m_at == m_text.size())
    {
      this->fail(m_at, "there is no shape");
    }
    const Shape shape = this->list(1);
    this->skip();
    if (m_at != m_text.size())
    {
      this->fail(m_at, "something follows the shape: put all into one list, as (unite ...)");
    }
    return shape;
  }

private:
  [[noreturn]] void fail(std::size_t at, const std::string& what) const
  {
    std::size_t line = 1;
    std::size_t column = 1;
    for (std::size_t i = 0; i < at; ++i)
    {
      column = m_text[i] == '\n' ? 1 : column + 1;
      line += m_text[i] == '\n';
    }
    throw std::invalid_argument(
      "line " + std::to_string(line) + ", column " + std::to_string(column) + ": " + what);
  }

  /// Over blanks and comments.
  void skip()
  {
    for (; m_at < m_text.size(); ++m_at)
    {
      if (m_text[m_at] == ';')
      {
        while (m_at + 1 < m_text.size() && m_text[m_at + 1] != '\n')
        {
          ++m_at;
        }
      }
      else if (m_text[m_at] != ' ' && m_text[m_at] != '\t' && m_text[m_at] != '\n' &&
               m_text[m_at] != '\r')
      {
        return;
      }
    }
  }

  /// A name or a number: all up to a blank, a bracket or a comment.
  std::string token()
  {
    const std::size_t begin = m_at;
    m_at = std::min(m_text.find_first_of(" \t\n\r();", m_at), m_text.size());
    return m_text.substr(begin, m_at - begin);
  }

  double number()
  {
    const std::size_t at = m_at;
    const std::string word = this->token();
    const char* begin = word.c_str() + (word[0] == '+' ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(begin, word.c_str() + word.size(), value);
    if (error != std::errc() || end != word.c_str() + word.size() || !std::isfinite(value))
    {
      this->fail(at, "\"" + word + "\" is not a number that can be used here");
    }
    return value;
  }

  Shape list(int depth)
  {
    const std::size_t begin = m_at;
    if (m_text[m_at] != '(')
    {
      this->fail(m_at, "a shape begins with a bracket, as in (sphere 1)");
    }
    if (depth > 200 || ++m_lists > 5000)
    {
      this->fail(m_at, depth > 200 ? "lists are nested deeper than 200" : "more than 5000 lists");
    }
    ++m_at;
    this->skip();
    const std::size_t name_at = m_at;
    const std::string name = this->token();
    const Word& word = this->word(name, name_at);
    Numbers numbers;
    Parts parts;
    while (true)
    {
      this->skip();
      if (m_at == m_text.size())
      {
        this->fail(begin, "the bracket opened here is not closed");
      }
      if (m_text[m_at] == ')')
      {
        ++m_at;
        break;
      }
      if (m_text[m_at] == '(')
      {
        parts.push_back(this->list(depth + 1));
      }
      else if (parts.empty())
      {
        numbers.push_back(this->number());
      }
      else
      {
        this->fail(m_at, std::string("numbers come before shapes: ") + word.usage);
      }
    }
    bool counted = false;
    for (const std::size_t n : word.numbers)
    {
      counted = counted || n == numbers.size();
    }
    if (!counted || parts.size() < word.least_parts || parts.size() > word.most_parts)
    {
      this->fail(begin,
        std::string("here are ") + std::to_string(numbers.size()) + " numbers and " +
          std::to_string(parts.size()) + " shapes, but it is " + word.usage);
    }
    try
    {
      return word.make(numbers, parts);
    }
    catch (const std::invalid_argument& problem)
    {
      this->fail(begin, problem.what());
    }
  }

  const Word& word(const std::string& name, std::size_t at) const
  {
    std::string known;
    for (const Word& w : words())
    {
      if (name == w.name)
      {
        return w;
      }
      known.append(known.empty() ? "" : ", ").append(w.name);
    }
    this->fail(at, std::string("\"").append(name, 0, 40).append("\" is no shape: there are ") + known);
  }

  const std::string& m_text;
  std::size_t m_at = 0;
  int m_lists = 0;
};

}

Shape shape_from_text(const std::string& text)
{
  return Reader(text).read();
}

}
