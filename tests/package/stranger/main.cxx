// Uses the installed package as a stranger would: a public class, and a library below it.
#include <vtkBrumeVolumeMapper.h>

#include <Transport/film.h>

#include <iostream>
#include <type_traits>

int main()
{
  static_assert(std::is_base_of<vtkVolumeMapper, vtkBrumeVolumeMapper>::value, "a volume mapper");
  const brume::Film film(4, 3);
  std::cout << film.size() << " pixels\n";
  return film.size() == 12 ? 0 : 1;
}
