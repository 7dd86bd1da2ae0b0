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
  void OnTestPartResult(const testing::TestPartResult& result) override
  {
    if (result.skipped())
    {
      std::string reason = result.message();
      for (char& c : reason)
      {
        c = c == '\n' ? ' ' : c;
      }
      const auto* info = testing::UnitTest::GetInstance()->current_test_info();
      std::cout << "skipped: " << (info ? std::string(info->test_suite_name()) + "." + info->name() + ": " : "")
                << reason << std::endl;
    }
  }
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
