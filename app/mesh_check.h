// Whether a file of a surface is whole: VTK's readers take much on trust, and end the program where a
// file is cut off or names points that it does not have.
#pragma once

#include <string>

class vtkPolyData;

namespace brume::app
{

/// What is wrong with a .ply file, as a clause; empty where its elements are all there.
std::string check_ply(const std::string& path);

/// What is wrong with an .obj file; empty where its faces name points, normals and texture points that
/// it has.
std::string check_obj(const std::string& path);

/// What is wrong with a surface; empty where its cells name points that it has, and all are finite.
std::string check_surface(vtkPolyData* mesh);

}
