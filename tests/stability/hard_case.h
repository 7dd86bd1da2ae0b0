// Hard cases: each is asserted and recorded in one go, so that docs/dev/hard-cases.md lists what
// the tests have measured and nothing else.
#pragma once

#include <string>
#include <vector>

namespace brume_tests
{

/// One case of docs/dev/hard-cases.md. It is told as it was measured when it goes out of scope.
///
///     HardCase thin("Optics", "optical depth 1e-30", "1 − e^(−τ) cancels", "a relative 1e-7");
///     for (each target)
///       thin.measure(error, 1e-7, "relative", target);
///
/// Whatever is measured is also expected: a value above its bound, or NaN, fails the running test.
/// Of several values of one unit the worst beside its bound is told, with the names of all that
/// gave one. A case without any measurement fails.
///
/// Where the environment variable BRUME_HARD_CASES names a folder, the program's cases are written
/// to FOLDER/PROGRAM.json. Two cases of a program in one group must not share a name.
class HardCase
{
public:
  /// `group` is the heading that the case stands under, `name` the case itself, `why` what makes it
  /// hard, `promise` what holds all the same, with its bound. Markdown, on one line.
  HardCase(std::string group, std::string name, std::string why, std::string promise);
  ~HardCase();
  HardCase(const HardCase&) = delete;
  HardCase& operator=(const HardCase&) = delete;

  /// Expects value ≤ bound, both ≥ 0. `unit` is what the value is ("relative", "of white", "ulp");
  /// `by` is what was run: an integrator, a mapper, a SIMD target, or several with ", " between.
  HardCase& measure(double value, double bound, const std::string& unit, const std::string& by);

  /// Expects that something held that has no figure. `what` says it in a few words ("no pixel is
  /// NaN"); how often it was asked is told.
  HardCase& holds(bool held, const std::string& what, const std::string& by);

  /// Expects that something held as often as it was tried: expect_property()'s result, and
  /// property_trials().
  HardCase& holds(int held, int tried, const std::string& what, const std::string& by);

  /// Expects that `message`, an error's text, names `part`: what is refused must say why.
  HardCase& refuses(const std::string& message, const std::string& part, const std::string& by);

  /// Tells a figure of another renderer, `by`, on the same case. It has no bound: it stands beside
  /// what was measured. Of several of one unit the largest is told, or NaN.
  HardCase& tell(double value, const std::string& unit, const std::string& by);

  /// Tells in words why another renderer's figures are what they are, or what it did instead of
  /// giving one ("crashes").
  HardCase& tell(const std::string& words, const std::string& by);

  struct Measured
  {
    std::string unit;
    double value = 0.0;
    double bound = 0.0;
    bool counted = false; ///< a thing that held `value` times of `bound`, not an error
  };

private:
  struct Told
  {
    std::string by;
    std::vector<Measured> figures; ///< without bounds
    std::string words;
  };

  void ran(const std::string& by);
  Told& told_by(const std::string& by);

  std::string Group, Name, Why, Promise;
  std::vector<Measured> Figures; ///< in the order of their first measurement
  std::vector<std::string> By;   ///< likewise
  std::vector<Told> Others;
};

/// What stands above the cases of a group on the page; may differ from machine to machine.
void introduce_group(const std::string& group, const std::string& text);

}
