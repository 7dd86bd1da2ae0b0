// The main() of every GoogleTest program here: as gtest_main's, but a program whose every test was
// skipped exits with 77, which CTest counts as skipped, and each skipped test is named with its
// reason on a line that scripts/test repeats.
#include <gtest/gtest.h>

#include <iostream>
#include <string>

namespace
{
class TellSkipped : public testing::EmptyTestEventListener
{
  // UnitTest::current_test_info() would wait for the lock that is held while a result is told.
  void OnTestStart(const testing::TestInfo& test) override
  {
    this->Name = std::string(test.test_suite_name()) + "." + test.name() + ": ";
  }
  void OnTestEnd(const testing::TestInfo&) override { this->Name.clear(); }
  void OnTestPartResult(const testing::TestPartResult& result) override
  {
    if (result.skipped())
    {
      std::string reason = result.message();
      for (char& c : reason)
      {
        c = c == '\n' ? ' ' : c;
      }
      std::cout << "skipped: " << this->Name << reason << std::endl;
    }
  }
  std::string Name; ///< of the test that runs
};
}

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  auto& unit = *testing::UnitTest::GetInstance();
  unit.listeners().Append(new TellSkipped); // owned by GoogleTest
  const int status = RUN_ALL_TESTS();
  const bool only_skipped = unit.skipped_test_count() > 0 && unit.successful_test_count() == 0;
  return status == 0 && only_skipped ? 77 : status;
}
