"""Dear ImGui and ImPlot as the toolkit of panels, painted in software: no OpenGL is needed."""
