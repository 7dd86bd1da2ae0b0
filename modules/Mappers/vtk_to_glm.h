// VTK's matrices and points as GLM's. Internal to Mappers.
#ifndef vtk_to_glm_h
#define vtk_to_glm_h

#include "vtkMatrix4x4.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace brume
{

inline glm::dmat4 to_glm(vtkMatrix4x4* m)
{
  glm::dmat4 result;
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      result[column][row] = m->GetElement(row, column);
    }
  }
  return result;
}

inline glm::dvec3 to_glm(const double v[3])
{
  return { v[0], v[1], v[2] };
}

}

#endif
