"""PyMeshLab 2025.7.post1 with the filters of meshlab_willmore.

Written by `python -m generate.pymeshlab_stubs`.
"""
# pyright: reportOverlappingOverload=false

from collections.abc import Iterator, Sequence
from typing import Any, Literal, TypedDict, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import NotRequired

class InvalidEnumException(Exception):
    """Exception raised when an invalid enum value is used as argument of a filter."""

class InvalidPercentageException(Exception):
    """Exception raised when an invalid value (not between 0 and 100) is set in a Percentage object."""

class MissingCompactnessException(Exception):
    """Exception raised when the compactness of some components of a Mesh is required."""

class MissingComponentException(Exception):
    """Exception raised when a component required by a filter is missing in a Mesh object."""

class PyMeshLabException(Exception):
    """Generic PyMeshLab exception."""

class PercentageValue:
    def __init__(self, arg0: float, /) -> None:
        """Constructor of the Percentage class."""
    def set_value(self, arg0: float, /) -> None:
        """Sets the value of the percentage."""
    def value(self) -> float:
        """Returns the value of the percentage [0-100]."""

class PureValue:
    def __init__(self, arg0: float, /) -> None:
        """Constructor of the AbsoluteValue class."""
    def set_value(self, arg0: float, /) -> None:
        """Sets the value of the absolute value."""
    def value(self) -> float:
        """Returns the value of the absolute value."""

class Color:
    @overload
    def __init__(self, r: int, g: int, b: int) -> None:
        """Constructs a color with the int RGB values r, g, b, and the alpha-channel (transparency) value of 255."""
    @overload
    def __init__(self, r: int, g: int, b: int, a: int) -> None:
        """Constructs a color with the int RGB values r, g, b, and the alpha-channel (transparency) value of a."""
    def alpha(self) -> int:
        """Returns the alpha color component of this color as integer."""
    def alpha_f(self) -> float:
        """Returns the alpha color component of this color as float."""
    def blue(self) -> int:
        """Returns the blue color component of this color as integer."""
    def blue_f(self) -> float:
        """Returns the blue color component of this color as float."""
    def green(self) -> int:
        """Returns the green color component of this color as integer."""
    def green_f(self) -> float:
        """Returns the green color component of this color as float."""
    def red(self) -> int:
        """Returns the red color component of this color as integer."""
    def red_f(self) -> float:
        """Returns the red color component of this color as float."""
    def set_alpha(self, a: int) -> None:
        """Sets the alpha color component of this color to a."""
    def set_alpha_f(self, a: float) -> None:
        """Sets the alpha color component of this color to a."""
    def set_blue(self, b: int) -> None:
        """Sets the blue color component of this color to b."""
    def set_blue_f(self, b: float) -> None:
        """Sets the blue color component of this color to b."""
    def set_green(self, g: int) -> None:
        """Sets the green color component of this color to g."""
    def set_green_f(self, g: float) -> None:
        """Sets the green color component of this color to g."""
    def set_red(self, r: int) -> None:
        """Sets the red color component of this color to r."""
    def set_red_f(self, r: float) -> None:
        """Sets the red color component of this color to r."""
    def to_array3(self) -> NDArray[np.int32]:
        """Returns a numpy array of 3 integers containing the rgb components of this color."""
    def to_array3f(self) -> NDArray[np.float32]:
        """Returns a numpy array of 3 floats containing the rgb components of this color."""
    def to_array4(self) -> NDArray[np.int32]:
        """Returns a numpy array of 4 integers containing the rgba components of this color."""
    def to_array4f(self) -> NDArray[np.float32]:
        """Returns a numpy array of 4 floats containing the rgba components of this color."""

class BoundingBox:
    def __init__(self) -> None:
        """Creates an invalid Bounding Box (min: [1,1,1], max:[-1,-1,-1])."""
    def center(self) -> NDArray[np.float64]:
        """Returns the center point coordinate of the Bounding Box."""
    def diagonal(self) -> float:
        """Returns the diagonal of the Bounding Box."""
    def dim_x(self) -> float:
        """Returns the X size of the Bounding Box."""
    def dim_y(self) -> float:
        """Returns the Y size of the Bounding Box."""
    def dim_z(self) -> float:
        """Returns the Z size of the Bounding Box."""
    def max(self) -> NDArray[np.float64]:
        """Returns the max coordinate of the Bounding Box."""
    def min(self) -> NDArray[np.float64]:
        """Returns the min coordinate of the Bounding Box."""

class Image:
    def height(self) -> int: ...
    def save(self, file_name: str, quality: int=-1) -> None:
        """Save the image to the given filename, deducing automatically the format from the file name, and with a given quality with default value -1 (default setting of the save process)."""
    def width(self) -> int: ...

class Mesh:
    @overload
    def __init__(self, vertex_matrix: ArrayLike=..., face_matrix: ArrayLike=..., edge_matrix: ArrayLike=..., v_normals_matrix: ArrayLike=..., f_normals_matrix: ArrayLike=..., v_scalar_array: ArrayLike=..., f_scalar_array: ArrayLike=..., v_color_matrix: ArrayLike=..., f_color_matrix: ArrayLike=..., v_tex_coords_matrix: ArrayLike=..., w_tex_coords_matrix: ArrayLike=...) -> None:
        """Creates a mesh containing the data passed as input."""
    @overload
    def __init__(self, vertex_matrix: ArrayLike, face_list_of_indices: Sequence[ArrayLike], v_normals_matrix: ArrayLike=..., f_normals_matrix: ArrayLike=..., v_scalar_array: ArrayLike=..., f_scalar_array: ArrayLike=..., v_color_matrix: ArrayLike=..., f_color_matrix: ArrayLike=..., v_tex_coords_matrix: ArrayLike=...) -> None:
        """Creates a polygon mesh containing the data passed as input."""
    def add_face_custom_point_attribute(self, attribute_values: ArrayLike, attribute_name: str) -> None:
        """Adds a new user defined 3D point attribute associated to the faces of the mesh."""
    def add_face_custom_scalar_attribute(self, attribute_values: ArrayLike, attribute_name: str) -> None:
        """Adds a new user defined scalar attribute associated to the faces of the mesh."""
    def add_vertex_custom_point_attribute(self, attribute_values: ArrayLike, attribute_name: str) -> None:
        """Adds a new user defined 3D point attribute associated to the vertices of the mesh."""
    def add_vertex_custom_scalar_attribute(self, attribute_values: ArrayLike, attribute_name: str) -> None:
        """Adds a new user defined scalar attribute associated to the vertices of the mesh."""
    def bounding_box(self) -> BoundingBox:
        """Returns the bounding box of the mesh."""
    def compact(self) -> None:
        """Compacts all the arrays of the mesh."""
    def edge_matrix(self) -> NDArray[np.int32]:
        """Returns the edge matrix of the mesh as a numpy array, which is a #E*2 matrix of vertex indices."""
    def edge_number(self) -> int:
        """Returns the number of edges of the mesh."""
    def face_color_array(self) -> NDArray[np.uint32]:
        """Returns the face color array as a numpy array, which is a #F array of unsigned integers, each value is the ARGB packed in a 32bit unsigned int (8 bits per component)."""
    def face_color_matrix(self) -> NDArray[np.float64]:
        """Returns the face color matrix as a numpy array, which is a #V*4 matrix of floats, each component (RGBA) is in the interval [0, 1]."""
    def face_curvature_principal_dir1_matrix(self) -> NDArray[np.float64]:
        """Returns the face curvature - principal direction 1 matrix of the mesh as a numpy array."""
    def face_curvature_principal_dir2_matrix(self) -> NDArray[np.float64]:
        """Returns the face curvature - principal direction 2 matrix of the mesh as a numpy array."""
    def face_custom_point_attribute_matrix(self, arg0: str, /) -> NDArray[np.float64]:
        """Returns a numpy matrix containing the 3D point values of the given user defined attribute name associated to the faces of the mesh."""
    def face_custom_scalar_attribute_array(self, arg0: str, /) -> NDArray[np.float64]:
        """Returns a numpy array containing the scalar values of the given user defined attribute name associated to the faces of the mesh."""
    def face_face_adjacency_matrix(self) -> NDArray[np.int32]:
        """Returns face-to-face adjacency matrix of the mesh as a numpy array."""
    def face_matrix(self) -> NDArray[np.int32]:
        """Returns the face matrix of the mesh as a numpy array, which is a #F*3 matrix of vertex indices."""
    def face_normal_matrix(self) -> NDArray[np.float64]:
        """Returns the face normal matrix of the mesh as a numpy array, which is a #F*3 matrix of face normals."""
    def face_number(self) -> int:
        """Returns the number of faces of the mesh."""
    def face_scalar_array(self) -> NDArray[np.float64]:
        """Returns the face scalar array of the mesh as a numpy array, which is a #F array of floats."""
    def face_selection_array(self) -> NDArray[np.bool_]:
        """Returns the face selection array of the mesh as a numpy array,which is a #F array of booleans (true if the corresponding face is selected, false otherwise)."""
    def has_face_color(self) -> bool:
        """Returns true if the mesh has the face color component, false otherwise."""
    def has_face_scalar(self) -> bool:
        """Returns true if the mesh has the face scalar component, false otherwise."""
    def has_vertex_color(self) -> bool:
        """Returns true if the mesh has the vertex color component, false otherwise."""
    def has_vertex_scalar(self) -> bool:
        """Returns true if the mesh has the vertex scalar component, false otherwise."""
    def has_vertex_tex_coord(self) -> bool:
        """Returns true if the mesh has the vertex texture coordinate component, false otherwise."""
    def has_wedge_tex_coord(self) -> bool:
        """Returns true if the mesh has the wedge texture coordinate component, false otherwise."""
    def id(self) -> int:
        """Returns the id of the mesh into a MeshSet."""
    def is_compact(self) -> bool:
        """Returns true if all its arrays are compact."""
    def is_point_cloud(self) -> bool:
        """Returns true if the mesh has no faces (it is a point cloud)"""
    def is_visible(self) -> bool:
        """Returns a boolean indicating whether the mesh is marked as visible or not."""
    def label(self) -> str:
        """Returns a the label associated to the Mesh."""
    def polygonal_face_list(self) -> list[NDArray[np.uint32]]:
        """Returns a list of numpy arrays."""
    def selected_face_number(self) -> int:
        """Returns the number of selected faces of the mesh."""
    def selected_vertex_number(self) -> int:
        """Returns the number of selected vertices of the mesh."""
    def set_label(self, arg0: str, /) -> None:
        """Sets the label associated to the mesh."""
    @overload
    def texture(self, arg0: int, /) -> Image:
        """Returns the texture of the Mesh at the given index."""
    @overload
    def texture(self, arg0: str, /) -> Image:
        """Returns the texture of the Mesh with the given name."""
    def texture_number(self) -> int:
        """Returns the number of textures contained in the mesh."""
    def textures(self) -> dict[str, Image]:
        """Returns a dictionary with the texture names as keys and the texture images of the mesh as values."""
    def transform_matrix(self) -> NDArray[np.float64]:
        """Returns the 4x4 transform matrix associated to the mesh."""
    def transformed_vertex_matrix(self) -> NDArray[np.float64]:
        """Returns the vertex matrix of the mesh as a numpy array, which is a #V*3 matrix of vertex coordinates."""
    def update_bounding_box(self) -> None:
        """Updates the bounding box of the mesh."""
    def update_topology(self) -> None:
        """Updates the topology of the mesh."""
    def vertex_color_array(self) -> NDArray[np.uint32]:
        """Returns the vertex color array as a numpy array, which is a #V array of unsigned integers, each value is the ARGB packed in a 32bit unsigned int (8 bits per component)."""
    def vertex_color_matrix(self) -> NDArray[np.float64]:
        """Returns the vertex color matrix as a numpy array, which is a #V*4 matrix of floats, each component (RGBA) is in the interval [0, 1]."""
    def vertex_curvature_principal_dir1_matrix(self) -> NDArray[np.float64]:
        """Returns the vertex curvature - principal direction 1 matrix of the mesh as a numpy array."""
    def vertex_curvature_principal_dir2_matrix(self) -> NDArray[np.float64]:
        """Returns the vertex curvature - principal direction 2 matrix of the mesh as a numpy array."""
    def vertex_custom_point_attribute_matrix(self, arg0: str, /) -> NDArray[np.float64]:
        """Returns a numpy matrix containing the 3D point values of the given user defined attribute name associated to the vertices of the mesh."""
    def vertex_custom_scalar_attribute_array(self, arg0: str, /) -> NDArray[np.float64]:
        """Returns a numpy array containing the scalar values of the given user defined attribute name associated to the vertices of the mesh."""
    def vertex_matrix(self) -> NDArray[np.float64]:
        """Returns the vertex matrix of the mesh as a numpy array, which is a #V*3 matrix of vertex coordinates."""
    def vertex_normal_matrix(self) -> NDArray[np.float64]:
        """Returns the vertex normal matrix of the mesh as a numpy array, which is a #V*3 matrix of vertex normals."""
    def vertex_number(self) -> int:
        """Returns the number of vertices of the mesh."""
    def vertex_scalar_array(self) -> NDArray[np.float64]:
        """Returns the vertex scalar array of the mesh as a numpy array, which is a #V array of floats."""
    def vertex_selection_array(self) -> NDArray[np.bool_]:
        """Returns the vertex selection array of the mesh as a numpy array, which is a #V array of booleans (true if the corresponding vertex is selected, false otherwise)."""
    def vertex_tex_coord_matrix(self) -> NDArray[np.float64]:
        """Returns the vertex texcoord matrix of the mesh as a numpy array, which is a #V*2 matrix of uv texture coordinates."""
    def wedge_tex_coord_matrix(self) -> NDArray[np.float64]:
        """Returns the per-wedge texcoord matrix of the mesh as a numpy array, which is a #(F*3)*2 matrix of uv texture coordinates (triplets of wedges texcoords for each face)."""

class _ComputeMatrixByFittingToPlane(TypedDict):
    fitting_plane_avg_error: float
    fitting_plane_normal: NDArray[np.float64]
    rotation_angle: float
    rotation_axis: NDArray[np.float64]

_ComputeScalarByDiscreteCurvaturePerVertex = TypedDict("_ComputeScalarByDiscreteCurvaturePerVertex", {"10_percentile": float, "90_percentile": float, "curv_range_max": float, "curv_range_min": float})
class _GetAreaAndPerimeterOfSelection(TypedDict):
    border_edge_number: int
    perimeter: float
    seleced_triangles_number: int
    selected_surface_area: float

class _GetGeometricMeasures(TypedDict):
    avg_edge_inc_faux_length: float
    avg_edge_length: float
    axis_momenta: NDArray[np.float64]
    barycenter: NDArray[np.float64]
    bbox: BoundingBox
    center_of_mass: NDArray[np.float64]
    inertia_tensor: NDArray[np.float64]
    mesh_volume: float
    pca: NDArray[np.float64]
    shell_barycenter: NDArray[np.float64]
    surface_area: float
    total_edge_inc_faux_length: float
    total_edge_length: float
    vertex_quality_weighted_barycenter: NotRequired[NDArray[np.float64]]

class _GetHausdorffDistance(TypedDict):
    RMS: float
    diag_mesh_0: float
    diag_mesh_1: float
    max: float
    mean: float
    min: float
    n_samples: int

class _GetScalarHistogramPerFace(TypedDict):
    hist_bin_max: NDArray[np.float64]
    hist_bin_min: NDArray[np.float64]
    hist_count: NDArray[np.float64]

class _GetScalarHistogramPerVertex(TypedDict):
    hist_bin_max: NDArray[np.float64]
    hist_bin_min: NDArray[np.float64]
    hist_count: NDArray[np.float64]

class _GetScalarStatisticsPerFace(TypedDict):
    avg: float
    max: float
    med: float
    min: float
    stddev: float
    variance: float

class _GetScalarStatisticsPerVertex(TypedDict):
    avg: float
    max: float
    med: float
    min: float
    stddev: float
    variance: float

class _GetTopologicalMeasures(TypedDict):
    boundary_edges: int
    connected_components_number: int
    edges_number: int
    faces_number: int
    genus: int
    incident_faces_on_non_two_manifold_edges: int
    incident_faces_on_non_two_manifold_vertices: int
    is_mesh_two_manifold: bool
    non_two_manifold_edges: int
    non_two_manifold_vertices: int
    number_holes: int
    unreferenced_vertices: int
    vertices_number: int

_GetTopologicalMeasuresFromQuadMesh = TypedDict("_GetTopologicalMeasuresFromQuadMesh", {"large_polys_number": int, "polys_number": int, "quad_ratio_avg": float, "quad_ratio_max": float, "quad_ratio_min": float, "quads_number": int, "right_angle_discrepancy_avg": float, "right_angle_discrepancy_max": float, "right_angle_discrepancy_min": float, "right_angle_discrepancy_perc0.05": float, "right_angle_discrepancy_perc95": float, "right_angle_discrepancy_stddev": float, "triangles_number": int})
class _GetWillmoreMeasures(TypedDict):
    area: float
    """Area of the surface."""
    gaussian_curvature: float
    """Sum of 2 pi minus the angles, over interior vertices (radians); 2 pi times the Euler characteristic where the mesh is closed."""
    absolute_gaussian_curvature: float
    """The same sum of absolute values."""
    absolute_mean_curvature: float
    """Sum of dihedral angle times length over interior edges."""
    willmore_energy: float
    """Sum of the Willmore energies of interior vertices (radians)."""

class _MeshingCloseHoles(TypedDict):
    closed_holes: int
    new_faces: int

class _MeshingEdgeFlipByWillmoreOptimization(TypedDict):
    flips: int
    """Number of flips; with 'annealing', of new edges."""
    gain: float
    """How much the energy fell, in its unit; with the presets of several passes, how much the Willmore energy fell; for 'virtual willmore' the sum over the flips with the greedy searches, else the drop of the Willmore energy."""
    willmore_before: float
    """Willmore energy before, over interior vertices, in radians."""
    willmore_after: float
    """Willmore energy after, over interior vertices, in radians."""
    absolute_mean_curvature_before: float
    """Sum of dihedral angle times length over interior edges, before."""
    absolute_mean_curvature_after: float
    """The same after."""
    mean_shape_before: float
    """Mean of the triangles' shapes before; 1: all equilateral."""
    mean_shape_after: float
    """The same after."""
    worst_shape_before: float
    """Least of the triangles' shapes before; 0: one without area."""
    worst_shape_after: float
    """The same after."""
    deviation: float
    """No point of the surface is farther than this from the surface before, nor the other way round, in units of the coordinates."""
    converged: bool
    """Whether no allowed flip lowers the energy any more."""
    seconds: float
    """Time spent."""
    mesh_id: int
    """Id of the current mesh, which the flips do not change."""

_FilterName = Literal["apply_cameras_extrinsics_transformation", "apply_cameras_rotation", "apply_cameras_scaling", "apply_cameras_translation", "apply_color_brightness_contrast_gamma_per_vertex", "apply_color_desaturation_per_vertex", "apply_color_equalization_per_vertex", "apply_color_intensity_colourisation_per_vertex", "apply_color_inverse_per_vertex", "apply_color_laplacian_smoothing_per_face", "apply_color_laplacian_smoothing_per_vertex", "apply_color_level_adjustment_per_vertex", "apply_color_noising_per_vertex", "apply_color_thresholding_per_vertex", "apply_color_unsharp_mask_per_vertex", "apply_color_white_balance_per_vertex", "apply_coord_craters_from_point_cloud", "apply_coord_cubic_stylization", "apply_coord_depth_smoothing", "apply_coord_developability_of_mesh", "apply_coord_directional_preservation", "apply_coord_fractal_displacement", "apply_coord_hc_laplacian_smoothing", "apply_coord_laplacian_smoothing", "apply_coord_laplacian_smoothing_scale_dependent", "apply_coord_laplacian_smoothing_surface_preserving", "apply_coord_point_cloud_movement_over_mesh", "apply_coord_random_displacement", "apply_coord_taubin_smoothing", "apply_coord_two_steps_smoothing", "apply_coord_unsharp_mask", "apply_matrix_flip_or_swap_axis", "apply_matrix_freeze", "apply_matrix_inverse", "apply_normal_normalization_per_face", "apply_normal_normalization_per_vertex", "apply_normal_point_cloud_smoothing", "apply_normal_smoothing_per_face", "apply_normal_unsharp_mask_per_vertex", "apply_scalar_clamping_per_vertex", "apply_scalar_saturation_per_vertex", "apply_scalar_smoothing_per_vertex", "apply_scalar_unsharp_mask_per_vertex", "apply_selection_by_same_connected_component", "apply_selection_dilatation", "apply_selection_erosion", "apply_selection_inverse", "apply_texcoord_merge_per_wedge", "apply_texmap_defragmentation", "compute_color_and_texture_from_active_rasters_projection", "compute_color_by_conntected_component_per_face", "compute_color_by_function_per_face", "compute_color_by_function_per_vertex", "compute_color_by_point_cloud_voronoi_projection", "compute_color_from_active_rasters_projection", "compute_color_from_current_raster_projection", "compute_color_from_scalar_per_face", "compute_color_from_scalar_per_vertex", "compute_color_from_scalar_using_transfer_function_per_vertex", "compute_color_from_texture_per_vertex", "compute_color_perlin_noise_per_vertex", "compute_color_random_per_face", "compute_color_scattering_per_mesh", "compute_color_transfer_face_to_vertex", "compute_color_transfer_mesh_to_face", "compute_color_transfer_vertex_to_face", "compute_coord_by_function", "compute_coord_linear_morphing", "compute_curvature_and_color_apss_per_vertex", "compute_curvature_and_color_rimls_per_vertex", "compute_curvature_principal_directions_per_vertex", "compute_custom_radius_scalar_attribute_per_vertex", "compute_iso_parametrization", "compute_matrix_by_fitting_to_plane", "compute_matrix_by_icp_between_meshes", "compute_matrix_by_mesh_global_alignment", "compute_matrix_by_principal_axis", "compute_matrix_from_rotation", "compute_matrix_from_scaling_or_normalization", "compute_matrix_from_translation", "compute_matrix_from_translation_rotation_scale", "compute_mls_projection_apss", "compute_mls_projection_rimls", "compute_new_custom_point_attribute_per_face", "compute_new_custom_point_attribute_per_vertex", "compute_new_custom_scalar_attribute_per_face", "compute_new_custom_scalar_attribute_per_vertex", "compute_normal_by_function_per_face", "compute_normal_by_function_per_vertex", "compute_normal_for_point_clouds", "compute_normal_from_cameras_per_vertex", "compute_normal_per_face", "compute_normal_per_vertex", "compute_normal_polygon_mesh_per_face", "compute_scalar_ambient_occlusion", "compute_scalar_ambient_occlusion_gpu", "compute_scalar_by_aspect_ratio_per_face", "compute_scalar_by_border_distance_per_vertex", "compute_scalar_by_discrete_curvature_per_vertex", "compute_scalar_by_distance_from_another_mesh_per_vertex", "compute_scalar_by_distance_from_point_cloud_per_vertex", "compute_scalar_by_function_per_face", "compute_scalar_by_function_per_vertex", "compute_scalar_by_geodesic_distance_from_given_point_per_vertex", "compute_scalar_by_geodesic_distance_from_selection_per_vertex", "compute_scalar_by_heat_geodesic_distance_from_selection_per_vertex", "compute_scalar_by_scalar_harmonic_field_per_vertex", "compute_scalar_by_shape_diameter_function_per_vertex", "compute_scalar_by_shape_diameter_function_per_vertex_gpu", "compute_scalar_by_volumetric_obscurance", "compute_scalar_by_volumetric_obscurance_gpu", "compute_scalar_by_willmore_energy_per_vertex", "compute_scalar_from_camera_per_vertex", "compute_scalar_from_raster_coverage_per_face", "compute_scalar_from_raster_coverage_per_vertex", "compute_scalar_transfer_face_to_vertex", "compute_scalar_transfer_vertex_to_face", "compute_selection_bad_faces", "compute_selection_by_angle_with_direction_per_face", "compute_selection_by_color_per_face", "compute_selection_by_condition_per_face", "compute_selection_by_condition_per_vertex", "compute_selection_by_edge_length", "compute_selection_by_non_manifold_edges_per_face", "compute_selection_by_non_manifold_per_vertex", "compute_selection_by_scalar_per_face", "compute_selection_by_scalar_per_vertex", "compute_selection_by_self_intersections_per_face", "compute_selection_by_small_disconnected_components_per_face", "compute_selection_by_texture_seams_per_vertex", "compute_selection_crease_per_edge", "compute_selection_from_mesh_border", "compute_selection_of_visible_convex_hull_per_vertex", "compute_selection_point_cloud_outliers", "compute_selection_transfer_face_to_vertex", "compute_selection_transfer_vertex_to_face", "compute_texcoord_by_function_per_vertex", "compute_texcoord_by_function_per_wedge", "compute_texcoord_parametrization_and_texture_from_registered_rasters", "compute_texcoord_parametrization_flat_plane_per_wedge", "compute_texcoord_parametrization_from_registered_rasters", "compute_texcoord_parametrization_harmonic", "compute_texcoord_parametrization_least_squares_conformal_maps", "compute_texcoord_parametrization_triangle_trivial_per_wedge", "compute_texcoord_transfer_vertex_to_wedge", "compute_texcoord_transfer_wedge_to_vertex", "compute_texmap_from_color", "create_annulus", "create_cone", "create_cube", "create_dodecahedron", "create_dodecahedron_sym", "create_fractal_terrain", "create_grid", "create_icosahedron", "create_implicit_surface", "create_mesh_by_grammar", "create_noisy_isosurface", "create_octahedron", "create_sphere", "create_sphere_cap", "create_sphere_points", "create_tetrahedron", "create_torus", "delete_current_mesh", "delete_current_raster", "delete_non_active_rasters", "delete_non_visible_meshes", "export_mesh_to_sketchfab", "generate_alpha_shape", "generate_alpha_wrap", "generate_boolean_difference", "generate_boolean_intersection", "generate_boolean_union", "generate_boolean_xor", "generate_by_merging_visible_meshes", "generate_convex_hull", "generate_copy_of_current_mesh", "generate_cylindrical_unwrapping", "generate_dust_accumulation_point_cloud", "generate_from_selected_faces", "generate_from_selected_vertices", "generate_iso_parametrization_atlased_mesh", "generate_iso_parametrization_remeshing", "generate_marching_cubes_apss", "generate_marching_cubes_rimls", "generate_plane_fitting_to_selection", "generate_polyline_from_planar_section", "generate_polyline_from_selected_edges", "generate_polyline_from_selection_perimeter", "generate_resampled_uniform_mesh", "generate_sampling_clustered_vertex", "generate_sampling_element", "generate_sampling_montecarlo", "generate_sampling_poisson_disk", "generate_sampling_regular_recursive", "generate_sampling_stratified_triangle", "generate_sampling_texel", "generate_sampling_volumetric", "generate_sampling_voronoi", "generate_simplified_point_cloud", "generate_solid_wireframe", "generate_splitting_by_connected_components", "generate_surface_reconstruction_ball_pivoting", "generate_surface_reconstruction_screened_poisson", "generate_surface_reconstruction_vcg", "generate_voronoi_atlas_parametrization", "generate_voronoi_filtering", "generate_voronoi_scaffolding", "get_area_and_perimeter_of_selection", "get_depth_complexity", "get_geometric_measures", "get_hausdorff_distance", "get_overlapping_meshes_graph", "get_scalar_histogram_per_face", "get_scalar_histogram_per_vertex", "get_scalar_statistics_per_face", "get_scalar_statistics_per_vertex", "get_topological_measures", "get_topological_measures_from_quad_mesh", "get_willmore_measures", "load_active_raster_cameras", "meshing_close_holes", "meshing_cut_along_crease_edges", "meshing_decimation_clustering", "meshing_decimation_edge_collapse_for_marching_cube_meshes", "meshing_decimation_quadric_edge_collapse", "meshing_decimation_quadric_edge_collapse_with_texture", "meshing_edge_flip_by_curvature_optimization", "meshing_edge_flip_by_planar_optimization", "meshing_edge_flip_by_willmore_optimization", "meshing_invert_face_orientation", "meshing_isotropic_explicit_remeshing", "meshing_merge_close_vertices", "meshing_poly_to_tri", "meshing_re_orient_faces_by_geometry", "meshing_re_orient_faces_coherently", "meshing_refine_by_function", "meshing_remove_all_faces", "meshing_remove_connected_component_by_diameter", "meshing_remove_connected_component_by_face_number", "meshing_remove_duplicate_faces", "meshing_remove_duplicate_vertices", "meshing_remove_folded_faces", "meshing_remove_null_faces", "meshing_remove_selected_faces", "meshing_remove_selected_vertices", "meshing_remove_selected_vertices_and_faces", "meshing_remove_t_vertices", "meshing_remove_unreferenced_vertices", "meshing_remove_vertices_by_scalar", "meshing_repair_non_manifold_edges", "meshing_repair_non_manifold_vertices", "meshing_snap_mismatched_borders", "meshing_surface_subdivision_butterfly", "meshing_surface_subdivision_catmull_clark", "meshing_surface_subdivision_doo_sabin", "meshing_surface_subdivision_loop", "meshing_surface_subdivision_ls3_loop", "meshing_surface_subdivision_midpoint", "meshing_tri_to_quad_by_4_8_subdivision", "meshing_tri_to_quad_by_smart_triangle_pairing", "meshing_tri_to_quad_dominant", "meshing_vertex_attribute_seam", "nxs_build", "nxs_compress", "raster_alignment_mutual_information", "raster_global_refinement_mutual_information", "save_active_raster_cameras", "save_snapshot", "set_camera_per_mesh", "set_camera_per_raster", "set_color_per_vertex", "set_matrix", "set_matrix_identity", "set_mesh_name", "set_raster_name", "set_selection_all", "set_selection_none", "set_texture_per_mesh", "transfer_attributes_per_vertex", "transfer_attributes_to_texture_per_vertex", "transfer_iso_parametrization_between_meshes", "transfer_texture_to_color_per_vertex"]

class MeshSet:
    def __getitem__(self, id: int) -> Mesh:
        """Returns a reference to the mesh having the given id in the MeshSet."""
    def __init__(self, verbose: bool=False) -> None:
        """Initializes a MeshSet, setting the verbosity with the given value (default is False)."""
    def __iter__(self) -> Iterator[Mesh]: ...
    def __len__(self) -> int:
        """This function is deprecated."""
    def add_mesh(self, mesh: Mesh, mesh_name: str='', set_as_current: bool=True) -> None:
        """Adds a copy of the given mesh in the current MeshSet, with the given name."""
    def apply_filter_script(self) -> None:
        """Applies all the filters currently present in the filter script."""
    def clear(self) -> None:
        """Clears the meshset, deleting all its content."""
    def clear_filter_script(self) -> None:
        """Clears the current filter script."""
    def current_mesh(self) -> Mesh:
        """Returns the current mesh of the MeshSet."""
    def current_mesh_id(self) -> int:
        """Returns the id of the current mesh of the MeshSet."""
    def filter_parameter_values(self, arg0: str, /, **kwargs: Any) -> dict[str, Any]:
        """Returns a dictionary containing the parameters and their values that would be used by the given filter if the 'apply_filter' function is called in the current MeshSet."""
    def is_current_mesh_visible(self) -> bool:
        """Returns a boolean indicating whether the current mesh is visible or not."""
    def is_mesh_visible(self, id: int) -> bool:
        """Returns a boolean indicating whether the mesh with the given ID is visible or not."""
    def load_filter_script(self, filter_script_name: str) -> None:
        """Loads from a .mlx file the current filter script."""
    def load_new_mesh(self, file_name: str, **kwargs: Any) -> None:
        """Loads the mesh in the given filename and adds the mesh in the MeshSet."""
    def load_new_raster(self, file_name: str) -> None:
        """Loads the raster in the given filename and adds the raster in the MeshSet."""
    def load_project(self, file_name: str | Sequence[str]) -> None:
        """Loads a project from the given file name(s) and stores it in the MeshSet."""
    def mesh(self, id: int) -> Mesh:
        """Returns a reference to the mesh having the given id in the MeshSet."""
    def mesh_id_exists(self, id: int) -> bool:
        """Returns true if the given id exists in the MeshSet."""
    def mesh_number(self) -> int:
        """Returns the number of meshes contained in the MeshSet."""
    def number_meshes(self) -> int:
        """This function is deprecated."""
    def number_rasters(self) -> int:
        """This function is deprecated."""
    def print_filter_script(self) -> None:
        """Prints all the filters present on the current filter script, with all the parameters and their values."""
    def print_status(self) -> None:
        """Prints the status of the MeshSet (number of meshes, and for every mesh its ID, its label and its full name.)"""
    def raster_number(self) -> int:
        """Returns the number of rasters contained in the MeshSet."""
    def save_current_mesh(self, file_name: str, save_textures: bool=True, texture_quality: int=-1, **kwargs: Any) -> None:
        """Saves the current mesh in the MeshSet in a file having the given file name."""
    def save_filter_script(self, filter_script_name: str) -> None:
        """Saves in a .mlx file the current filter script."""
    def save_project(self, file_name: str) -> None:
        """Saves the content of the MeshSet in a file having the given file name."""
    def set_current_mesh(self, new_curr_id: int) -> None:
        """Selects as current mesh the mesh having the given ID."""
    def set_current_mesh_visibility(self, visibility: bool) -> None:
        """Sets the visibility of the current mesh according to the given boolean argument."""
    def set_mesh_visibility(self, id: int, visibility: bool) -> None:
        """Sets the visibility of the mesh with the given ID according to the given boolean argument."""
    def set_parameter_verbosity(self, verbosity: bool) -> None:
        """Sets the verbosity of the MeshSet, regarding only the print of the parameters when running afilter."""
    def set_verbosity(self, verbosity: bool) -> None:
        """Sets the verbosity when using the MeshSet class."""
    def show_polyscope(self) -> None:
        """Shows all meshes in a window of Polyscope, a package of its own."""
    @overload
    def apply_filter(self, filter_name: Literal["compute_matrix_by_fitting_to_plane"], **kwargs: Any) -> _ComputeMatrixByFittingToPlane: ...
    @overload
    def apply_filter(self, filter_name: Literal["compute_scalar_by_discrete_curvature_per_vertex"], **kwargs: Any) -> _ComputeScalarByDiscreteCurvaturePerVertex: ...
    @overload
    def apply_filter(self, filter_name: Literal["get_area_and_perimeter_of_selection"], **kwargs: Any) -> _GetAreaAndPerimeterOfSelection: ...
    @overload
    def apply_filter(self, filter_name: Literal["get_geometric_measures"], **kwargs: Any) -> _GetGeometricMeasures: ...
    @overload
    def apply_filter(self, filter_name: Literal["get_hausdorff_distance"], **kwargs: Any) -> _GetHausdorffDistance: ...
    @overload
    def apply_filter(self, filter_name: Literal["get_scalar_histogram_per_face"], **kwargs: Any) -> _GetScalarHistogramPerFace: ...
    @overload
    def apply_filter(self, filter_name: Literal["get_scalar_histogram_per_vertex"], **kwargs: Any) -> _GetScalarHistogramPerVertex: ...
    @overload
    def apply_filter(self, filter_name: Literal["get_scalar_statistics_per_face"], **kwargs: Any) -> _GetScalarStatisticsPerFace: ...
    @overload
    def apply_filter(self, filter_name: Literal["get_scalar_statistics_per_vertex"], **kwargs: Any) -> _GetScalarStatisticsPerVertex: ...
    @overload
    def apply_filter(self, filter_name: Literal["get_topological_measures"], **kwargs: Any) -> _GetTopologicalMeasures: ...
    @overload
    def apply_filter(self, filter_name: Literal["get_topological_measures_from_quad_mesh"], **kwargs: Any) -> _GetTopologicalMeasuresFromQuadMesh: ...
    @overload
    def apply_filter(self, filter_name: Literal["get_willmore_measures"], **kwargs: Any) -> _GetWillmoreMeasures: ...
    @overload
    def apply_filter(self, filter_name: Literal["meshing_close_holes"], **kwargs: Any) -> _MeshingCloseHoles: ...
    @overload
    def apply_filter(self, filter_name: Literal["meshing_edge_flip_by_willmore_optimization"], **kwargs: Any) -> _MeshingEdgeFlipByWillmoreOptimization: ...
    @overload
    def apply_filter(self, filter_name: _FilterName | str, **kwargs: Any) -> dict[str, Any]:
        """Applies the filter having the given filter name in the MeshSet."""
    def apply_cameras_extrinsics_transformation(
        self,
        *,
        transformmatrix: ArrayLike = ...,
        camera: Literal["Raster Camera", "Mesh Camera"] | int = "Raster Camera",
        behaviour: Literal["The matrix is the transformation to apply to the extrinsics", "The matrix represent the new extrinsics"] | int = "The matrix is the transformation to apply to the extrinsics",
        toallraster: bool = False,
        toall: bool = False,
    ) -> None:
        """Transform the camera extrinsics, or all the cameras of the project

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_cameras_extrinsics_transformation
        """
    def apply_cameras_rotation(
        self,
        *,
        camera: Literal["Raster Camera", "Mesh Camera"] | int = "Raster Camera",
        rotaxis: Literal["X axis", "Y axis", "Z axis", "custom axis"] | int = "X axis",
        rotcenter: Literal["origin", "camera viewpoint", "custom point"] | int = "origin",
        angle: float = 0.0,
        customaxis: ArrayLike = ...,
        customcenter: ArrayLike = ...,
        toallraster: bool = False,
        toall: bool = False,
    ) -> None:
        """Transform: Rotate Camera or set of cameras

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_cameras_rotation
        """
    def apply_cameras_scaling(
        self,
        *,
        camera: Literal["Raster Camera", "Mesh Camera"] | int = "Raster Camera",
        scalecenter: Literal["origin", "camera viewpoint", "custom point"] | int = "origin",
        customcenter: ArrayLike = ...,
        scale: float = 1.0,
        toallraster: bool = False,
        toall: bool = False,
    ) -> None:
        """Transform: Scale Camera or set of cameras

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_cameras_scaling
        """
    def apply_cameras_translation(
        self,
        *,
        camera: Literal["Raster Camera", "Mesh Camera"] | int = "Raster Camera",
        axisx: float = 0.0,
        axisy: float = 0.0,
        axisz: float = 0.0,
        centerflag: bool = False,
        toallraster: bool = False,
        toall: bool = False,
    ) -> None:
        """Transform: Translate Camera or set of cameras

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_cameras_translation
        """
    def apply_color_brightness_contrast_gamma_per_vertex(
        self,
        *,
        brightness: float = 0.0,
        contrast: float = 0.0,
        gamma: float = 1.0,
        onselected: bool = False,
    ) -> None:
        """Vertex Color Brightness Contrast Gamma

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_brightness_contrast_gamma_per_vertex
        """
    def apply_color_desaturation_per_vertex(
        self,
        *,
        method: Literal["Lightness", "Luminosity", "Average"] | int = "Lightness",
        onselected: bool = False,
    ) -> None:
        """Vertex Color Desaturation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_desaturation_per_vertex
        """
    def apply_color_equalization_per_vertex(
        self,
        *,
        rch: bool = True,
        gch: bool = True,
        bch: bool = True,
        onselected: bool = False,
    ) -> None:
        """Equalize Vertex Color

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_equalization_per_vertex
        """
    def apply_color_intensity_colourisation_per_vertex(
        self,
        *,
        hue: float = 0.0,
        saturation: float = 100.0,
        luminance: float = 50.0,
        intensity: float = 50.0,
        onselected: bool = False,
    ) -> None:
        """Vertex Color Colourisation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_intensity_colourisation_per_vertex
        """
    def apply_color_inverse_per_vertex(
        self,
        *,
        onselected: bool = False,
    ) -> None:
        """Vertex Color Invert

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_inverse_per_vertex
        """
    def apply_color_laplacian_smoothing_per_face(
        self,
        *,
        iteration: int = 1,
    ) -> None:
        """Smooth: Laplacian Face Color

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_laplacian_smoothing_per_face
        """
    def apply_color_laplacian_smoothing_per_vertex(
        self,
        *,
        iteration: int = 1,
    ) -> None:
        """Smooth: Laplacian Vertex Color

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_laplacian_smoothing_per_vertex
        """
    def apply_color_level_adjustment_per_vertex(
        self,
        *,
        gamma: float = 1.0,
        in_min: float = 0.0,
        in_max: float = 255.0,
        out_min: float = 0.0,
        out_max: float = 255.0,
        rch: bool = True,
        gch: bool = True,
        bch: bool = True,
        onselected: bool = False,
        apply_to_all: bool = False,
    ) -> None:
        """Vertex Color Levels Adjustment

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_level_adjustment_per_vertex
        """
    def apply_color_noising_per_vertex(
        self,
        *,
        noisebits: int = 1,
        onselected: bool = False,
    ) -> None:
        """Color noise

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_noising_per_vertex
        """
    def apply_color_thresholding_per_vertex(
        self,
        *,
        color1: Color = ...,
        color2: Color = ...,
        threshold: float = 128.0,
        onselected: bool = False,
    ) -> None:
        """Vertex Color Thresholding

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_thresholding_per_vertex
        """
    def apply_color_unsharp_mask_per_vertex(
        self,
        *,
        weight: float = 0.3,
        weightorig: float = 1.0,
        iterations: int = 5,
    ) -> None:
        """UnSharp Mask Color

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_unsharp_mask_per_vertex
        """
    def apply_color_white_balance_per_vertex(
        self,
        *,
        color: Color = ...,
        onselected: bool = False,
    ) -> None:
        """Vertex Color White Balance

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_color_white_balance_per_vertex
        """
    def apply_coord_craters_from_point_cloud(
        self,
        *,
        target_mesh: int = ...,
        samples_mesh: int = ...,
        seed: int = 0,
        smoothingsteps: int = 5,
        rbf: Literal["f1 (Gaussian)", "f2 (Multiquadric)", "f3"] | int = "f2 (Multiquadric)",
        min_radius: float = 0.1,
        max_radius: float = 0.35,
        min_depth: float = 0.05,
        max_depth: float = 0.15,
        elevation: float = 0.4,
        blend: Literal["Exponential blending", "Linear blending", "Gaussian blending", "f3 blending"] | int = "f3 blending",
        blendthreshold: float = 0.8,
        successiveimpacts: bool = True,
        ppnoise: bool = True,
        invert: bool = False,
        save_as_quality: bool = False,
    ) -> None:
        """Craters Generation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_craters_from_point_cloud
        """
    def apply_coord_cubic_stylization(
        self,
        *,
        lcubeness: float = 0.2,
        applyef: bool = False,
        applycol: bool = False,
    ) -> None:
        """Cubic stylization

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_cubic_stylization
        """
    def apply_coord_depth_smoothing(
        self,
        *,
        stepsmoothnum: int = 3,
        viewpoint: ArrayLike = ...,
        delta: PercentageValue | PureValue = ...,
        selected: bool = ...,
    ) -> None:
        """Depth Smooth

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_depth_smoothing
        """
    def apply_coord_developability_of_mesh(
        self,
        *,
        optmethod: Literal["[F] Fixed stepsize", "[B] Backtracking line search"] | int = "[B] Backtracking line search",
        maxfunevals: int = 400,
        eps: float = 1e-05,
        stepsize: float = 0.01,
        minstepsize: float = 1e-10,
        tau: float = 0.8,
        m1: float = 0.0001,
        edgeflips: bool = True,
        edgecollapses: bool = True,
        anglethreshold: float = 18.0,
    ) -> None:
        """Make mesh developable

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_developability_of_mesh
        """
    def apply_coord_directional_preservation(
        self,
        *,
        attr_name: str,
        viewpoint: ArrayLike = ...,
    ) -> dict[str, Any] | None:
        """Directional Geometry Preservation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_directional_preservation
        """
    def apply_coord_fractal_displacement(
        self,
        *,
        maxheight: PercentageValue | PureValue = ...,
        scale: float = 1.0,
        smoothingsteps: int = 5,
        seed: float = 2.0,
        algorithm: Literal["fBM (fractal Brownian Motion)", "Standard multifractal", "Heterogeneous multifractal", "Hybrid multifractal terrain", "Ridged multifractal terrain"] | int = "Ridged multifractal terrain",
        octaves: float = 8.0,
        lacunarity: float = 4.0,
        fractalincrement: float = 0.2,
        offset: float = 0.9,
        gain: float = 2.5,
        saveasquality: bool = False,
    ) -> None:
        """Fractal Displacement

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_fractal_displacement
        """
    def apply_coord_hc_laplacian_smoothing(
        self,
    ) -> None:
        """HC Laplacian Smooth

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_hc_laplacian_smoothing
        """
    def apply_coord_laplacian_smoothing(
        self,
        *,
        stepsmoothnum: int = 3,
        boundary: bool = True,
        cotangentweight: bool = True,
        selected: bool = ...,
    ) -> None:
        """Laplacian Smooth

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_laplacian_smoothing
        """
    def apply_coord_laplacian_smoothing_scale_dependent(
        self,
        *,
        stepsmoothnum: int = 3,
        delta: PercentageValue | PureValue = ...,
        selected: bool = ...,
    ) -> None:
        """ScaleDependent Laplacian Smooth

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_laplacian_smoothing_scale_dependent
        """
    def apply_coord_laplacian_smoothing_surface_preserving(
        self,
        *,
        selection: bool = False,
        angledeg: float = 0.5,
        iterations: int = 1,
    ) -> None:
        """Laplacian Smooth (surface preserving)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_laplacian_smoothing_surface_preserving
        """
    def apply_coord_point_cloud_movement_over_mesh(
        self,
        *,
        point_cloud: int = ...,
        target_mesh: int = ...,
        gravity_dir: ArrayLike = ...,
        force_dir: ArrayLike = ...,
        steps: int = 1,
        adhesion: float = 1.0,
        velocity: float = 0.0,
        mass: float = 1.0,
        colorize_mesh: bool = False,
    ) -> None:
        """Points Cloud Movement

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_point_cloud_movement_over_mesh
        """
    def apply_coord_random_displacement(
        self,
        *,
        updatenormals: bool = True,
        displacement: PercentageValue | PureValue = ...,
        randomseed: int = 0,
    ) -> None:
        """Random Vertex Displacement

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_random_displacement
        """
    def apply_coord_taubin_smoothing(
        self,
        *,
        lambda_: float = 0.5,
        mu: float = -0.53,
        stepsmoothnum: int = 10,
        selected: bool = ...,
    ) -> None:
        """Taubin Smooth

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_taubin_smoothing
        """
    def apply_coord_two_steps_smoothing(
        self,
        *,
        stepsmoothnum: int = 3,
        normalthr: float = 60.0,
        stepnormalnum: int = 20,
        stepfitnum: int = 20,
        selected: bool = ...,
    ) -> None:
        """TwoStep Smooth

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_two_steps_smoothing
        """
    def apply_coord_unsharp_mask(
        self,
        *,
        weight: float = 0.3,
        weightorig: float = 1.0,
        iterations: int = 5,
    ) -> None:
        """UnSharp Mask Geometry

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_coord_unsharp_mask
        """
    def apply_matrix_flip_or_swap_axis(
        self,
        *,
        flipx: bool = False,
        flipy: bool = False,
        flipz: bool = False,
        swapxy: bool = False,
        swapxz: bool = False,
        swapyz: bool = False,
        freeze: bool = True,
        alllayers: bool = False,
    ) -> None:
        """Transform: Flip and/or swap axis

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_matrix_flip_or_swap_axis
        """
    def apply_matrix_freeze(
        self,
        *,
        alllayers: bool = False,
    ) -> None:
        """Matrix: Freeze Current Matrix

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_matrix_freeze
        """
    def apply_matrix_inverse(
        self,
        *,
        freeze: bool = True,
        alllayers: bool = False,
    ) -> None:
        """Matrix: Invert Current Matrix

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_matrix_inverse
        """
    def apply_normal_normalization_per_face(
        self,
    ) -> None:
        """Normalize Face Normals

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_normal_normalization_per_face
        """
    def apply_normal_normalization_per_vertex(
        self,
    ) -> None:
        """Normalize Vertex Normals

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_normal_normalization_per_vertex
        """
    def apply_normal_point_cloud_smoothing(
        self,
        *,
        k: int = 10,
        usedist: bool = False,
    ) -> None:
        """Smooth normals on point sets

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_normal_point_cloud_smoothing
        """
    def apply_normal_smoothing_per_face(
        self,
    ) -> None:
        """Smooth Face Normals

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_normal_smoothing_per_face
        """
    def apply_normal_unsharp_mask_per_vertex(
        self,
        *,
        recalc: bool = False,
        weight: float = 0.3,
        weightorig: float = 1.0,
        iterations: int = 5,
    ) -> None:
        """UnSharp Mask Normals

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_normal_unsharp_mask_per_vertex
        """
    def apply_scalar_clamping_per_vertex(
        self,
        *,
        minval: float = ...,
        maxval: float = ...,
        perc: float = 0.0,
        zerosym: bool = False,
    ) -> None:
        """Clamp Vertex Quality

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_scalar_clamping_per_vertex
        """
    def apply_scalar_saturation_per_vertex(
        self,
        *,
        gradientthr: float = 1.0,
        updatecolor: bool = False,
    ) -> None:
        """Saturate Vertex Quality

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_scalar_saturation_per_vertex
        """
    def apply_scalar_smoothing_per_vertex(
        self,
    ) -> None:
        """Smooth Vertex Quality

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_scalar_smoothing_per_vertex
        """
    def apply_scalar_unsharp_mask_per_vertex(
        self,
        *,
        weight: float = 0.3,
        weightorig: float = 1.0,
        iterations: int = 5,
    ) -> None:
        """UnSharp Mask Quality

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_scalar_unsharp_mask_per_vertex
        """
    def apply_selection_by_same_connected_component(
        self,
    ) -> None:
        """Select Connected Faces

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_selection_by_same_connected_component
        """
    def apply_selection_dilatation(
        self,
    ) -> None:
        """Dilate Selection

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_selection_dilatation
        """
    def apply_selection_erosion(
        self,
    ) -> None:
        """Erode Selection

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_selection_erosion
        """
    def apply_selection_inverse(
        self,
        *,
        invfaces: bool = ...,
        invverts: bool = False,
    ) -> None:
        """Invert Selection

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_selection_inverse
        """
    def apply_texcoord_merge_per_wedge(
        self,
        *,
        mergethr: float = 0.0001,
    ) -> None:
        """Merge Wedge Texture Coord

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_texcoord_merge_per_wedge
        """
    def apply_texmap_defragmentation(
        self,
        *,
        matchingthreshold: float = 2.0,
        boundarytolerance: float = 0.2,
        distortiontolerance: float = 0.5,
        globaldistortiontolerance: float = 0.025,
        uvreductionlimit: float = 0.0,
        offsetfactor: float = 5.0,
        timelimit: float = 0.0,
    ) -> dict[str, Any] | None:
        """Texture Map Defragmentation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#apply_texmap_defragmentation
        """
    def compute_color_and_texture_from_active_rasters_projection(
        self,
        *,
        textname: str = "_color.png",
        texsize: int = 1024,
        dorefill: bool = True,
        deptheta: float = 0.5,
        onselection: bool = False,
        useangle: bool = True,
        usedistance: bool = True,
        useborders: bool = True,
        usesilhouettes: bool = True,
        usealpha: bool = False,
    ) -> dict[str, Any] | None:
        """Project active rasters color to current mesh, filling the texture

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_and_texture_from_active_rasters_projection
        """
    def compute_color_by_conntected_component_per_face(
        self,
    ) -> None:
        """Random Component Color

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_by_conntected_component_per_face
        """
    def compute_color_by_function_per_face(
        self,
        *,
        r: str = "255",
        g: str = "0",
        b: str = "255",
        a: str = "255",
        onselected: bool = False,
    ) -> None:
        """Per Face Color Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_by_function_per_face
        """
    def compute_color_by_function_per_vertex(
        self,
        *,
        x: str = "255",
        y: str = "255",
        z: str = "0",
        a: str = "255",
        onselected: bool = False,
    ) -> None:
        """Per Vertex Color Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_by_function_per_vertex
        """
    def compute_color_by_point_cloud_voronoi_projection(
        self,
        *,
        coloredmesh: int = ...,
        vertexmesh: int = ...,
        backward: bool = False,
    ) -> None:
        """Voronoi Vertex Coloring

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_by_point_cloud_voronoi_projection
        """
    def compute_color_from_active_rasters_projection(
        self,
        *,
        deptheta: float = 0.5,
        onselection: bool = False,
        useangle: bool = True,
        usedistance: bool = True,
        useborders: bool = True,
        usesilhouettes: bool = True,
        usealpha: bool = False,
        blankcolor: Color = ...,
    ) -> dict[str, Any] | None:
        """Project active rasters color to current mesh

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_from_active_rasters_projection
        """
    def compute_color_from_current_raster_projection(
        self,
        *,
        usedepth: bool = True,
        deptheta: float = 0.5,
        onselection: bool = False,
        blankcolor: Color = ...,
    ) -> dict[str, Any] | None:
        """Project current raster color to current mesh

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_from_current_raster_projection
        """
    def compute_color_from_scalar_per_face(
        self,
        *,
        minval: float = 0.0,
        maxval: float = ...,
        perc: float = 0.0,
        zerosym: bool = False,
        colormap: Literal["RGB", "Viridis", "Plasma", "Cividis", "Turbo", "RdPu"] | int = "RGB",
    ) -> None:
        """Colorize by face Quality

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_from_scalar_per_face
        """
    def compute_color_from_scalar_per_vertex(
        self,
        *,
        minval: float = ...,
        maxval: float = ...,
        perc: float = 0.0,
        zerosym: bool = False,
        colormap: Literal["RGB", "Viridis", "Plasma", "Cividis", "Turbo", "RdPu"] | int = "RGB",
    ) -> None:
        """Colorize by vertex Quality

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_from_scalar_per_vertex
        """
    def compute_color_from_scalar_using_transfer_function_per_vertex(
        self,
        *,
        minqualityval: float = ...,
        maxqualityval: float = ...,
        midhandlepos: float = 50.0,
        brightness: float = 1.0,
        tfslist: Literal["Custom Transfer Function File", "Meshlab RGB", "RGB", "French RGB", "Red Scale", "Green Scale", "Blue Scale", "Flat", "Saw 4", "Saw 8", "Grey Scale"] | int = "Meshlab RGB",
        csvfilename: str = "",
    ) -> None:
        """Quality Mapper applier

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_from_scalar_using_transfer_function_per_vertex
        """
    def compute_color_from_texture_per_vertex(
        self,
    ) -> None:
        """Transfer Color: Texture to Vertex

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_from_texture_per_vertex
        """
    def compute_color_perlin_noise_per_vertex(
        self,
        *,
        color1: Color = ...,
        color2: Color = ...,
        freq: float = 10.0,
        offset: ArrayLike = ...,
        onselected: bool = False,
    ) -> None:
        """Perlin color

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_perlin_noise_per_vertex
        """
    def compute_color_random_per_face(
        self,
    ) -> None:
        """Random Face Color

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_random_per_face
        """
    def compute_color_scattering_per_mesh(
        self,
        *,
        seed: int = 0,
    ) -> None:
        """PerMesh Color Scattering

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_scattering_per_mesh
        """
    def compute_color_transfer_face_to_vertex(
        self,
    ) -> None:
        """Transfer Color: Face to Vertex

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_transfer_face_to_vertex
        """
    def compute_color_transfer_mesh_to_face(
        self,
        *,
        allvisiblemesh: bool = False,
    ) -> None:
        """Transfer Color: Mesh to Face

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_transfer_mesh_to_face
        """
    def compute_color_transfer_vertex_to_face(
        self,
    ) -> None:
        """Transfer Color: Vertex to Face

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_color_transfer_vertex_to_face
        """
    def compute_coord_by_function(
        self,
        *,
        x: str = "x",
        y: str = "y",
        z: str = "sin(x+y)",
        onselected: bool = False,
    ) -> None:
        """Per Vertex Geometric Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_coord_by_function
        """
    def compute_coord_linear_morphing(
        self,
        *,
        targetmesh: int = ...,
        percentmorph: float = 0.0,
    ) -> None:
        """Vertex Linear Morphing

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_coord_linear_morphing
        """
    def compute_curvature_and_color_apss_per_vertex(
        self,
        *,
        filterscale: float = 2.0,
        projectionaccuracy: float = 0.0001,
        maxprojectioniters: int = 15,
        sphericalparameter: float = 1.0,
        selectiononly: bool = False,
        curvaturetype: Literal["Mean", "Gauss", "K1", "K2", "ApproxMean"] | int = "Mean",
    ) -> None:
        """Colorize curvature (APSS)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_curvature_and_color_apss_per_vertex
        """
    def compute_curvature_and_color_rimls_per_vertex(
        self,
        *,
        filterscale: float = 2.0,
        projectionaccuracy: float = 0.0001,
        maxprojectioniters: int = 15,
        sigman: float = 0.75,
        maxrefittingiters: int = 3,
        selectiononly: bool = False,
        curvaturetype: Literal["Mean", "Gauss", "K1", "K2"] | int = "Mean",
    ) -> None:
        """Colorize curvature (RIMLS)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_curvature_and_color_rimls_per_vertex
        """
    def compute_curvature_principal_directions_per_vertex(
        self,
        *,
        method: Literal["Taubin approximation", "Principal Component Analysis", "Normal Cycles", "Quadric Fitting", "Scale Dependent Quadric Fitting"] | int = "Quadric Fitting",
        curvcolormethod: Literal["Mean Curvature", "Gaussian Curvature", "Min Curvature", "Max Curvature", "Shape Index", "CurvedNess", "None"] | int = "Mean Curvature",
        scale: PercentageValue | PureValue = ...,
        autoclean: bool = True,
    ) -> None:
        """Compute curvature principal directions

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_curvature_principal_directions_per_vertex
        """
    def compute_custom_radius_scalar_attribute_per_vertex(
        self,
        *,
        nbneighbors: int = 16,
    ) -> None:
        """Estimate radius from density

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_custom_radius_scalar_attribute_per_vertex
        """
    def compute_iso_parametrization(
        self,
        *,
        targetabstractminfacenum: int = 150,
        targetabstractmaxfacenum: int = 200,
        stopcriteria: Literal["Best Heuristic", "Area + Angle", "Regularity", "L2"] | int = "Area + Angle",
        convergencespeed: int = 1,
        doublestep: bool = True,
    ) -> None:
        """Iso Parametrization: Main

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_iso_parametrization
        """
    def compute_matrix_by_fitting_to_plane(
        self,
        *,
        targetplane: Literal["XY plane", "YZ plane", "ZX plane"] | int = "XY plane",
        rotaxis: Literal["any axis", "X axis", "Y axis", "Z axis"] | int = "any axis",
        toorigin: bool = True,
        freeze: bool = True,
        alllayers: bool = False,
    ) -> _ComputeMatrixByFittingToPlane:
        """Transform: Rotate to Fit to a plane

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_matrix_by_fitting_to_plane
        """
    def compute_matrix_by_icp_between_meshes(
        self,
        *,
        referencemesh: int = ...,
        sourcemesh: int = ...,
        samplenum: int = 2000,
        mindistabs: float = 10.0,
        trgdistabs: float = 0.005,
        maxiternum: int = 75,
        samplemode: bool = True,
        reducefactorperc: float = 0.8,
        passhifilter: float = 0.75,
        matchmode: bool = True,
        savelastiteration: bool = False,
    ) -> None:
        """ICP Between Meshes

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_matrix_by_icp_between_meshes
        """
    def compute_matrix_by_mesh_global_alignment(
        self,
        *,
        basemesh: int = ...,
        onlyvisiblemeshes: bool = False,
        ogsize: int = 50000,
        arcthreshold: float = 0.3,
        recalcthreshold: float = 0.1,
        samplenum: int = 2000,
        mindistabs: float = 10.0,
        trgdistabs: float = 0.005,
        maxiternum: int = 75,
        samplemode: bool = True,
        reducefactorperc: float = 0.8,
        passhifilter: float = 0.75,
        matchmode: bool = True,
    ) -> None:
        """Global Align Meshes

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_matrix_by_mesh_global_alignment
        """
    def compute_matrix_by_principal_axis(
        self,
        *,
        pointsflag: bool = True,
        freeze: bool = True,
        alllayers: bool = False,
    ) -> None:
        """Transform: Align to Principal Axis

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_matrix_by_principal_axis
        """
    def compute_matrix_from_rotation(
        self,
        *,
        rotaxis: Literal["X axis", "Y axis", "Z axis", "custom axis"] | int = "X axis",
        rotcenter: Literal["origin", "barycenter", "custom point"] | int = "origin",
        angle: float = 0.0,
        customaxis: ArrayLike = ...,
        customcenter: ArrayLike = ...,
        snapflag: bool = False,
        snapangle: float = 30.0,
        freeze: bool = True,
        alllayers: bool = False,
    ) -> None:
        """Transform: Rotate

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_matrix_from_rotation
        """
    def compute_matrix_from_scaling_or_normalization(
        self,
        *,
        axisx: float = 1.0,
        axisy: float = 1.0,
        axisz: float = 1.0,
        uniformflag: bool = True,
        scalecenter: Literal["origin", "barycenter", "custom point"] | int = "origin",
        customcenter: ArrayLike = ...,
        unitflag: bool = False,
        freeze: bool = True,
        alllayers: bool = False,
    ) -> None:
        """Transform: Scale, Normalize

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_matrix_from_scaling_or_normalization
        """
    def compute_matrix_from_translation(
        self,
        *,
        traslmethod: Literal["XYZ translation", "Center on Scene BBox", "Center on Layer BBox", "Set new Origin"] | int = "XYZ translation",
        axisx: float = 0.0,
        axisy: float = 0.0,
        axisz: float = 0.0,
        neworigin: ArrayLike = ...,
        freeze: bool = True,
        alllayers: bool = False,
    ) -> None:
        """Transform: Translate, Center, set Origin

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_matrix_from_translation
        """
    def compute_matrix_from_translation_rotation_scale(
        self,
        *,
        translationx: float = 0.0,
        translationy: float = 0.0,
        translationz: float = 0.0,
        rotationx: float = 0.0,
        rotationy: float = 0.0,
        rotationz: float = 0.0,
        scalex: float = 1.0,
        scaley: float = 1.0,
        scalez: float = 1.0,
        compose: bool = False,
        freeze: bool = True,
        alllayers: bool = False,
    ) -> None:
        """Matrix: Set from translation/rotation/scale

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_matrix_from_translation_rotation_scale
        """
    def compute_mls_projection_apss(
        self,
        *,
        controlmesh: int = ...,
        proxymesh: int = ...,
        selectiononly: bool = False,
        maxsubdivisions: int = 0,
        thangleindegree: float = 2.0,
        filterscale: float = 2.0,
        projectionaccuracy: float = 0.0001,
        maxprojectioniters: int = 15,
        sphericalparameter: float = 1.0,
        accuratenormal: bool = True,
    ) -> dict[str, Any] | None:
        """MLS projection (APSS)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_mls_projection_apss
        """
    def compute_mls_projection_rimls(
        self,
        *,
        controlmesh: int = ...,
        proxymesh: int = ...,
        selectiononly: bool = False,
        maxsubdivisions: int = 0,
        thangleindegree: float = 2.0,
        filterscale: float = 2.0,
        projectionaccuracy: float = 0.0001,
        maxprojectioniters: int = 15,
        sigman: float = 0.75,
        maxrefittingiters: int = 3,
    ) -> dict[str, Any] | None:
        """MLS projection (RIMLS)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_mls_projection_rimls
        """
    def compute_new_custom_point_attribute_per_face(
        self,
        *,
        name: str = "CustomAttrName",
        x_expr: str = "x0",
        y_expr: str = "y0",
        z_expr: str = "z0",
    ) -> None:
        """Define New Per Face Custom Point Attribute

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_new_custom_point_attribute_per_face
        """
    def compute_new_custom_point_attribute_per_vertex(
        self,
        *,
        name: str = "CustomAttrName",
        x_expr: str = "x",
        y_expr: str = "y",
        z_expr: str = "z",
    ) -> None:
        """Define New Per Vertex Custom Point Attribute

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_new_custom_point_attribute_per_vertex
        """
    def compute_new_custom_scalar_attribute_per_face(
        self,
        *,
        name: str = "CustomAttrName",
        expr: str = "fi",
    ) -> None:
        """Define New Per Face Custom Scalar Attribute

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_new_custom_scalar_attribute_per_face
        """
    def compute_new_custom_scalar_attribute_per_vertex(
        self,
        *,
        name: str = "CustomAttrName",
        expr: str = "x",
    ) -> None:
        """Define New Per Vertex Custom Scalar Attribute

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_new_custom_scalar_attribute_per_vertex
        """
    def compute_normal_by_function_per_face(
        self,
        *,
        x: str = "-fnx",
        y: str = "-fny",
        z: str = "-fnz",
        onselected: bool = False,
    ) -> None:
        """Per Face Normal Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_normal_by_function_per_face
        """
    def compute_normal_by_function_per_vertex(
        self,
        *,
        x: str = "-nx",
        y: str = "-ny",
        z: str = "-nz",
        onselected: bool = False,
    ) -> None:
        """Per Vertex Normal Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_normal_by_function_per_vertex
        """
    def compute_normal_for_point_clouds(
        self,
        *,
        k: int = 10,
        smoothiter: int = 0,
        flipflag: bool = False,
        viewpos: ArrayLike = ...,
    ) -> None:
        """Compute normals for point sets

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_normal_for_point_clouds
        """
    def compute_normal_from_cameras_per_vertex(
        self,
    ) -> dict[str, Any] | None:
        """Re-Orient vertex normals using cameras

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_normal_from_cameras_per_vertex
        """
    def compute_normal_per_face(
        self,
    ) -> None:
        """Re-Compute Face Normals

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_normal_per_face
        """
    def compute_normal_per_vertex(
        self,
        *,
        weightmode: Literal["Simple Average", "By Area", "By Angle", "As defined by N. Max"] | int = "Simple Average",
    ) -> None:
        """Re-Compute Vertex Normals

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_normal_per_vertex
        """
    def compute_normal_polygon_mesh_per_face(
        self,
    ) -> None:
        """Re-Compute Per-Polygon Face Normals

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_normal_polygon_mesh_per_face
        """
    def compute_scalar_ambient_occlusion(
        self,
        *,
        rays: int = 64,
    ) -> None:
        """Compute Ambient occlusion

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_ambient_occlusion
        """
    def compute_scalar_ambient_occlusion_gpu(
        self,
        *,
        occmode: Literal["per-Vertex", "per-Face (deprecated)"] | int = "per-Vertex",
        dirbias: float = 0.0,
        reqviews: int = 128,
        conedir: ArrayLike = ...,
        coneangle: float = 30.0,
        usegpu: bool = False,
        depthtexsize: int = 512,
    ) -> dict[str, Any] | None:
        """Ambient Occlusion

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_ambient_occlusion_gpu
        """
    def compute_scalar_by_aspect_ratio_per_face(
        self,
        *,
        metric: Literal["area/max side", "inradius/circumradius", "Mean ratio", "Area", "Texture Angle Distortion", "Texture Area Distortion", "Polygonal planarity (max)", "Polygonal planarity (relative)"] | int = "area/max side",
    ) -> None:
        """Per Face Quality according to Triangle shape and aspect ratio

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_aspect_ratio_per_face
        """
    def compute_scalar_by_border_distance_per_vertex(
        self,
    ) -> None:
        """Colorize by border distance

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_border_distance_per_vertex
        """
    def compute_scalar_by_discrete_curvature_per_vertex(
        self,
        *,
        curvaturetype: Literal["Mean Curvature", "Gaussian Curvature", "RMS Curvature", "ABS Curvature"] | int = "Mean Curvature",
    ) -> _ComputeScalarByDiscreteCurvaturePerVertex:
        """Discrete Curvatures

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_discrete_curvature_per_vertex
        """
    def compute_scalar_by_distance_from_another_mesh_per_vertex(
        self,
        *,
        measuremesh: int = ...,
        refmesh: int = ...,
        signeddist: bool = True,
        maxdist: PercentageValue | PureValue = ...,
    ) -> None:
        """Distance from Reference Mesh

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_distance_from_another_mesh_per_vertex
        """
    def compute_scalar_by_distance_from_point_cloud_per_vertex(
        self,
        *,
        coloredmesh: int = ...,
        vertexmesh: int = ...,
        radius: float = ...,
        sampleradius: bool = False,
        approximategeodetic: bool = False,
    ) -> None:
        """Disk Vertex Coloring

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_distance_from_point_cloud_per_vertex
        """
    def compute_scalar_by_function_per_face(
        self,
        *,
        q: str = "x0+y0+z0",
        normalize: bool = False,
        map: bool = False,
        onselected: bool = False,
    ) -> None:
        """Per Face Quality Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_function_per_face
        """
    def compute_scalar_by_function_per_vertex(
        self,
        *,
        q: str = "vi",
        normalize: bool = False,
        map: bool = False,
        onselected: bool = False,
    ) -> None:
        """Per Vertex Quality Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_function_per_vertex
        """
    def compute_scalar_by_geodesic_distance_from_given_point_per_vertex(
        self,
        *,
        startpoint: ArrayLike = ...,
        maxdistance: PercentageValue | PureValue = ...,
    ) -> None:
        """Colorize by geodesic distance from a given point

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_geodesic_distance_from_given_point_per_vertex
        """
    def compute_scalar_by_geodesic_distance_from_selection_per_vertex(
        self,
        *,
        maxdistance: PercentageValue | PureValue = ...,
    ) -> None:
        """Colorize by geodesic distance from the selected points

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_geodesic_distance_from_selection_per_vertex
        """
    def compute_scalar_by_heat_geodesic_distance_from_selection_per_vertex(
        self,
        *,
        m: float = 1.0,
    ) -> None:
        """Colorize by approximated geodesic distance from the selected points

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_heat_geodesic_distance_from_selection_per_vertex
        """
    def compute_scalar_by_scalar_harmonic_field_per_vertex(
        self,
        *,
        point1: ArrayLike = ...,
        point2: ArrayLike = ...,
        value1: float = 0.0,
        value2: float = 1.0,
        colorize: bool = True,
    ) -> None:
        """Generate Scalar Harmonic Field

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_scalar_harmonic_field_per_vertex
        """
    def compute_scalar_by_shape_diameter_function_per_vertex(
        self,
        *,
        rays: int = 64,
        cone_amplitude: float = 90.0,
    ) -> None:
        """Compute Shape-Diameter Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_shape_diameter_function_per_vertex
        """
    def compute_scalar_by_shape_diameter_function_per_vertex_gpu(
        self,
        *,
        onprimitive: Literal["On vertices", "On Faces"] | int = "On vertices",
        numberrays: int = 128,
        depthtexturesize: int = 512,
        peelingiteration: int = 10,
        peelingtolerance: float = 1e-07,
        coneangle: float = 120.0,
        removefalse: bool = True,
        removeoutliers: bool = False,
    ) -> dict[str, Any] | None:
        """Shape Diameter Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_shape_diameter_function_per_vertex_gpu
        """
    def compute_scalar_by_volumetric_obscurance(
        self,
        *,
        rays: int = 64,
        tau: float = 0.1,
    ) -> None:
        """Compute Obscurance

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_volumetric_obscurance
        """
    def compute_scalar_by_volumetric_obscurance_gpu(
        self,
        *,
        onprimitive: Literal["On vertices", "On Faces"] | int = "On vertices",
        numberrays: int = 128,
        depthtexturesize: int = 512,
        peelingiteration: int = 10,
        peelingtolerance: float = 1e-07,
        coneangle: float = 120.0,
        obscuranceexponent: float = 0.1,
    ) -> dict[str, Any] | None:
        """Volumetric obscurance

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_by_volumetric_obscurance_gpu
        """
    def compute_scalar_by_willmore_energy_per_vertex(
        self,
    ) -> None:
        """Write the discrete Willmore energy of each vertex into the vertex scalar."""
    def compute_scalar_from_camera_per_vertex(
        self,
        *,
        depth: bool = True,
        facing: bool = False,
        clip: bool = False,
        normalize: bool = False,
        map: bool = False,
    ) -> dict[str, Any] | None:
        """Vertex Quality from Camera

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_from_camera_per_vertex
        """
    def compute_scalar_from_raster_coverage_per_face(
        self,
        *,
        normalizequality: bool = False,
    ) -> dict[str, Any] | None:
        """Quality from raster coverage (Face)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_from_raster_coverage_per_face
        """
    def compute_scalar_from_raster_coverage_per_vertex(
        self,
        *,
        normalizequality: bool = False,
    ) -> dict[str, Any] | None:
        """Quality from raster coverage (Vertex)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_from_raster_coverage_per_vertex
        """
    def compute_scalar_transfer_face_to_vertex(
        self,
        *,
        areaweight: bool = True,
    ) -> None:
        """Transfer Quality: Face to Vertex

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_transfer_face_to_vertex
        """
    def compute_scalar_transfer_vertex_to_face(
        self,
    ) -> None:
        """Transfer Quality: Vertex to Face

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_scalar_transfer_vertex_to_face
        """
    def compute_selection_bad_faces(
        self,
        *,
        usear: bool = True,
        aratio: float = 0.02,
        usenf: bool = False,
        nfratio: float = 60.0,
        select_folded_faces: bool = False,
        folded_faces_angle_threshold: float = 160.0,
    ) -> None:
        """Select 'problematic' faces

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_bad_faces
        """
    def compute_selection_by_angle_with_direction_per_face(
        self,
        *,
        anglelimit: float = 75.0,
        usecamera: bool = False,
        viewpoint: ArrayLike = ...,
    ) -> None:
        """Select Faces by view angle

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_angle_with_direction_per_face
        """
    def compute_selection_by_color_per_face(
        self,
        *,
        color: Color = ...,
        colorspace: Literal["HSV", "RGB"] | int = "HSV",
        inclusive: bool = True,
        percentrh: float = 0.2,
        percentgs: float = 0.2,
        percentbv: float = 0.2,
    ) -> None:
        """Select Faces by Color

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_color_per_face
        """
    def compute_selection_by_condition_per_face(
        self,
        *,
        condselect: str = "(fi == 0)",
    ) -> None:
        """Conditional Face Selection

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_condition_per_face
        """
    def compute_selection_by_condition_per_vertex(
        self,
        *,
        condselect: str = "(q < 0)",
    ) -> None:
        """Conditional Vertex Selection

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_condition_per_vertex
        """
    def compute_selection_by_edge_length(
        self,
        *,
        threshold: float = ...,
    ) -> None:
        """Select Faces with edges longer than...

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_edge_length
        """
    def compute_selection_by_non_manifold_edges_per_face(
        self,
    ) -> None:
        """Select non Manifold Edges

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_non_manifold_edges_per_face
        """
    def compute_selection_by_non_manifold_per_vertex(
        self,
    ) -> None:
        """Select non Manifold Vertices

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_non_manifold_per_vertex
        """
    def compute_selection_by_scalar_per_face(
        self,
        *,
        minq: float = 0.0,
        maxq: float = ...,
        inclusive: bool = True,
    ) -> None:
        """Select by Face Quality

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_scalar_per_face
        """
    def compute_selection_by_scalar_per_vertex(
        self,
        *,
        minq: float = ...,
        maxq: float = ...,
        inclusive: bool = True,
    ) -> None:
        """Select by Vertex Quality

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_scalar_per_vertex
        """
    def compute_selection_by_self_intersections_per_face(
        self,
    ) -> None:
        """Select Self Intersecting Faces

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_self_intersections_per_face
        """
    def compute_selection_by_small_disconnected_components_per_face(
        self,
        *,
        nbfaceratio: float = 0.1,
        nonclosedonly: bool = False,
        nbneighbors: int = 16,
    ) -> None:
        """Select small disconnected component

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_small_disconnected_components_per_face
        """
    def compute_selection_by_texture_seams_per_vertex(
        self,
    ) -> None:
        """Select Vertex Texture Seams

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_by_texture_seams_per_vertex
        """
    def compute_selection_crease_per_edge(
        self,
        *,
        angledegneg: float = -45.0,
        angledegpos: float = 45.0,
    ) -> None:
        """Select Crease Edges

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_crease_per_edge
        """
    def compute_selection_from_mesh_border(
        self,
    ) -> None:
        """Select Border

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_from_mesh_border
        """
    def compute_selection_of_visible_convex_hull_per_vertex(
        self,
        *,
        radiusthreshold: float = 0.0,
        usecamera: bool = False,
        viewpoint: ArrayLike = ...,
        convex_hullfp: bool = False,
        triangvp: bool = False,
    ) -> None:
        """Select Convex Hull Visible Points

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_of_visible_convex_hull_per_vertex
        """
    def compute_selection_point_cloud_outliers(
        self,
        *,
        propthreshold: float = 0.8,
        knearest: int = 32,
    ) -> None:
        """Select Outliers

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_point_cloud_outliers
        """
    def compute_selection_transfer_face_to_vertex(
        self,
        *,
        inclusive: bool = True,
    ) -> None:
        """Select Vertices from Faces

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_transfer_face_to_vertex
        """
    def compute_selection_transfer_vertex_to_face(
        self,
        *,
        inclusive: bool = True,
    ) -> None:
        """Select Faces from Vertices

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_selection_transfer_vertex_to_face
        """
    def compute_texcoord_by_function_per_vertex(
        self,
        *,
        u: str = "x",
        v: str = "y",
        onselected: bool = False,
    ) -> None:
        """Per Vertex Texture Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texcoord_by_function_per_vertex
        """
    def compute_texcoord_by_function_per_wedge(
        self,
        *,
        u0: str = "x0",
        v0: str = "y0",
        u1: str = "x1",
        v1: str = "y1",
        u2: str = "x2",
        v2: str = "y2",
        onselected: bool = False,
    ) -> None:
        """Per Wedge Texture Function

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texcoord_by_function_per_wedge
        """
    def compute_texcoord_parametrization_and_texture_from_registered_rasters(
        self,
        *,
        texturesize: int = 1024,
        texturename: str = "texture.png",
        colorcorrection: bool = True,
        colorcorrectionfiltersize: int = 1,
        usedistanceweight: bool = True,
        useimgborderweight: bool = True,
        usealphaweight: bool = False,
        cleanisolatedtriangles: bool = True,
        stretchingallowed: bool = False,
        texturegutter: int = 4,
    ) -> dict[str, Any] | None:
        """Parameterization + texturing from registered rasters

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texcoord_parametrization_and_texture_from_registered_rasters
        """
    def compute_texcoord_parametrization_flat_plane_per_wedge(
        self,
        *,
        projectionplane: Literal["XY", "XZ", "YZ"] | int = "XY",
        aspectratio: bool = False,
        sidegutter: float = 0.0,
    ) -> None:
        """Parametrization: Flat Plane

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texcoord_parametrization_flat_plane_per_wedge
        """
    def compute_texcoord_parametrization_from_registered_rasters(
        self,
        *,
        usedistanceweight: bool = True,
        useimgborderweight: bool = True,
        usealphaweight: bool = False,
        cleanisolatedtriangles: bool = True,
        stretchingallowed: bool = False,
        texturegutter: int = 4,
    ) -> dict[str, Any] | None:
        """Parameterization from registered rasters

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texcoord_parametrization_from_registered_rasters
        """
    def compute_texcoord_parametrization_harmonic(
        self,
        *,
        harm_function: int = 1,
    ) -> None:
        """Harmonic Parametrization

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texcoord_parametrization_harmonic
        """
    def compute_texcoord_parametrization_least_squares_conformal_maps(
        self,
    ) -> None:
        """Least Squares Conformal Maps Parametrization

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texcoord_parametrization_least_squares_conformal_maps
        """
    def compute_texcoord_parametrization_triangle_trivial_per_wedge(
        self,
        *,
        sidedim: int = 0,
        textdim: int = 1024,
        border: int = 2,
        method: Literal["Basic", "Space-optimizing"] | int = "Space-optimizing",
    ) -> None:
        """Parametrization: Trivial Per-Triangle

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texcoord_parametrization_triangle_trivial_per_wedge
        """
    def compute_texcoord_transfer_vertex_to_wedge(
        self,
    ) -> None:
        """Convert PerVertex UV into PerWedge UV

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texcoord_transfer_vertex_to_wedge
        """
    def compute_texcoord_transfer_wedge_to_vertex(
        self,
    ) -> None:
        """Convert PerWedge UV into PerVertex UV

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texcoord_transfer_wedge_to_vertex
        """
    def compute_texmap_from_color(
        self,
        *,
        textname: str = "",
        textw: int = 1024,
        texth: int = 1024,
        overwrite: bool = False,
        pullpush: bool = True,
    ) -> None:
        """Transfer: Vertex Color to Texture

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#compute_texmap_from_color
        """
    def create_annulus(
        self,
        *,
        internalradius: float = 0.5,
        externalradius: float = 1.0,
        sides: int = 32,
    ) -> None:
        """Annulus

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_annulus
        """
    def create_cone(
        self,
        *,
        r0: float = 1.0,
        r1: float = 2.0,
        h: float = 3.0,
        subdiv: int = 36,
    ) -> None:
        """Cone

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_cone
        """
    def create_cube(
        self,
        *,
        size: float = 1.0,
    ) -> None:
        """Box/Cube

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_cube
        """
    def create_dodecahedron(
        self,
    ) -> None:
        """Dodecahedron

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_dodecahedron
        """
    def create_dodecahedron_sym(
        self,
    ) -> None:
        """Dodecahedron (symmetric)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_dodecahedron_sym
        """
    def create_fractal_terrain(
        self,
        *,
        steps: int = 8,
        maxheight: float = 0.2,
        scale: float = 1.0,
        seed: float = 2.0,
        algorithm: Literal["fBM (fractal Brownian Motion)", "Standard multifractal", "Heterogeneous multifractal", "Hybrid multifractal terrain", "Ridged multifractal terrain"] | int = "Ridged multifractal terrain",
        octaves: float = 8.0,
        lacunarity: float = 4.0,
        fractalincrement: float = 0.5,
        offset: float = 0.9,
        gain: float = 2.5,
        saveasquality: bool = False,
    ) -> None:
        """Fractal Terrain

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_fractal_terrain
        """
    def create_grid(
        self,
        *,
        numvertx: int = 10,
        numverty: int = 10,
        absscalex: float = 0.3,
        absscaley: float = 0.3,
        center: bool = False,
    ) -> None:
        """Grid Generator

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_grid
        """
    def create_icosahedron(
        self,
    ) -> None:
        """Icosahedron

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_icosahedron
        """
    def create_implicit_surface(
        self,
        *,
        voxelsize: float = 0.05,
        minx: float = -1.0,
        miny: float = -1.0,
        minz: float = -1.0,
        maxx: float = 1.0,
        maxy: float = 1.0,
        maxz: float = 1.0,
        expr: str = "x*x+y*y+z*z-0.5",
    ) -> None:
        """Implicit Surface

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_implicit_surface
        """
    def create_mesh_by_grammar(
        self,
        *,
        grammar: str = "set maxdepth 40 R1 R2 rule R1 { { x 1 rz 6 ry 6 s 0.99 } R1 { s 2 } sphere } rule R2 {{ x -1 rz 6 ry 6 s 0.99 } R2 { s 2 } sphere} ",
        seed: int = 1,
        sphereres: int = 1,
    ) -> dict[str, Any] | None:
        """Structure Synth Mesh Creation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_mesh_by_grammar
        """
    def create_noisy_isosurface(
        self,
        *,
        resolution: int = 64,
    ) -> None:
        """Noisy Isosurface

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_noisy_isosurface
        """
    def create_octahedron(
        self,
    ) -> None:
        """Octahedron

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_octahedron
        """
    def create_sphere(
        self,
        *,
        radius: float = 1.0,
        subdiv: int = 3,
    ) -> None:
        """Sphere

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_sphere
        """
    def create_sphere_cap(
        self,
        *,
        angle: float = 60.0,
        subdiv: int = 3,
    ) -> None:
        """Sphere Cap

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_sphere_cap
        """
    def create_sphere_points(
        self,
        *,
        pointnum: int = 100,
        spheregentech: Literal["Montecarlo", "Poisson Sampling", "DiscoBall", "Octahedron", "Fibonacci"] | int = "Octahedron",
    ) -> None:
        """Points on a Sphere

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_sphere_points
        """
    def create_tetrahedron(
        self,
    ) -> None:
        """Tetrahedron

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_tetrahedron
        """
    def create_torus(
        self,
        *,
        hradius: float = 3.0,
        vradius: float = 1.0,
        hsubdiv: int = 24,
        vsubdiv: int = 12,
    ) -> None:
        """Torus

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#create_torus
        """
    def delete_current_mesh(
        self,
    ) -> None:
        """Delete Current Mesh

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#delete_current_mesh
        """
    def delete_current_raster(
        self,
    ) -> None:
        """Delete Current Raster

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#delete_current_raster
        """
    def delete_non_active_rasters(
        self,
    ) -> None:
        """Delete all Non Selected Rasters

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#delete_non_active_rasters
        """
    def delete_non_visible_meshes(
        self,
    ) -> None:
        """Delete all non visible Mesh Layers

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#delete_non_visible_meshes
        """
    def export_mesh_to_sketchfab(
        self,
        *,
        sketchfabkeycode: str = "00000000",
        title: str = "MeshLabModel",
        description: str = "A model generated with meshlab",
        tags: str = "meshlab",
        isprivate: bool = False,
        ispublished: bool = False,
        autorotate: bool = True,
        saveapisetting: bool = False,
    ) -> dict[str, Any] | None:
        """Export to Sketchfab

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#export_mesh_to_sketchfab
        """
    def generate_alpha_shape(
        self,
        *,
        alpha: PercentageValue | PureValue = ...,
        filtering: Literal["Alpha Complex", "Alpha Shape"] | int = "Alpha Complex",
    ) -> None:
        """Alpha Complex/Shape

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_alpha_shape
        """
    def generate_alpha_wrap(
        self,
        *,
        alpha: PercentageValue | PureValue = ...,
        offset: PercentageValue | PureValue = ...,
    ) -> None:
        """Alpha Wrap

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_alpha_wrap
        """
    def generate_boolean_difference(
        self,
        *,
        first_mesh: int = ...,
        second_mesh: int = ...,
        transfer_face_color: bool = False,
        transfer_face_quality: bool = False,
        transfer_vert_color: bool = False,
        transfer_vert_quality: bool = False,
    ) -> None:
        """Mesh Boolean: Difference

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_boolean_difference
        """
    def generate_boolean_intersection(
        self,
        *,
        first_mesh: int = ...,
        second_mesh: int = ...,
        transfer_face_color: bool = False,
        transfer_face_quality: bool = False,
        transfer_vert_color: bool = False,
        transfer_vert_quality: bool = False,
    ) -> None:
        """Mesh Boolean: Intersection

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_boolean_intersection
        """
    def generate_boolean_union(
        self,
        *,
        first_mesh: int = ...,
        second_mesh: int = ...,
        transfer_face_color: bool = False,
        transfer_face_quality: bool = False,
        transfer_vert_color: bool = False,
        transfer_vert_quality: bool = False,
    ) -> None:
        """Mesh Boolean: Union

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_boolean_union
        """
    def generate_boolean_xor(
        self,
        *,
        first_mesh: int = ...,
        second_mesh: int = ...,
        transfer_face_color: bool = False,
        transfer_face_quality: bool = False,
        transfer_vert_color: bool = False,
        transfer_vert_quality: bool = False,
    ) -> None:
        """Mesh Boolean: Symmetric Difference (XOR)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_boolean_xor
        """
    def generate_by_merging_visible_meshes(
        self,
        *,
        mergevisible: bool = True,
        deletelayer: bool = True,
        mergevertices: bool = True,
        alsounreferenced: bool = True,
    ) -> None:
        """Flatten Visible Layers

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_by_merging_visible_meshes
        """
    def generate_convex_hull(
        self,
    ) -> None:
        """Convex Hull

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_convex_hull
        """
    def generate_copy_of_current_mesh(
        self,
    ) -> None:
        """Duplicate Current layer

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_copy_of_current_mesh
        """
    def generate_cylindrical_unwrapping(
        self,
        *,
        startangle: float = 0.0,
        endangle: float = 360.0,
        radius: float = 0.0,
    ) -> None:
        """Geometric Cylindrical Unwrapping

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_cylindrical_unwrapping
        """
    def generate_dust_accumulation_point_cloud(
        self,
        *,
        dust_dir: ArrayLike = ...,
        nparticles: int = 3,
        slippiness: float = 1.0,
        adhesion: float = 0.2,
        draw_texture: bool = False,
    ) -> None:
        """Dust Accumulation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_dust_accumulation_point_cloud
        """
    def generate_from_selected_faces(
        self,
        *,
        deleteoriginal: bool = True,
    ) -> None:
        """Move selected faces to another layer

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_from_selected_faces
        """
    def generate_from_selected_vertices(
        self,
        *,
        deleteoriginal: bool = True,
    ) -> None:
        """Move selected vertices to another layer

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_from_selected_vertices
        """
    def generate_iso_parametrization_atlased_mesh(
        self,
        *,
        bordersize: float = 0.1,
    ) -> dict[str, Any] | None:
        """Iso Parametrization Build Atlased Mesh

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_iso_parametrization_atlased_mesh
        """
    def generate_iso_parametrization_remeshing(
        self,
        *,
        samplingrate: int = 10,
    ) -> dict[str, Any] | None:
        """Iso Parametrization Remeshing

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_iso_parametrization_remeshing
        """
    def generate_marching_cubes_apss(
        self,
        *,
        filterscale: float = 2.0,
        projectionaccuracy: float = 0.0001,
        maxprojectioniters: int = 15,
        sphericalparameter: float = 1.0,
        accuratenormal: bool = True,
        resolution: int = 200,
    ) -> None:
        """Marching Cubes (APSS)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_marching_cubes_apss
        """
    def generate_marching_cubes_rimls(
        self,
        *,
        filterscale: float = 2.0,
        projectionaccuracy: float = 0.0001,
        maxprojectioniters: int = 15,
        sigman: float = 0.75,
        maxrefittingiters: int = 3,
        resolution: int = 200,
    ) -> None:
        """Marching Cubes (RIMLS)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_marching_cubes_rimls
        """
    def generate_plane_fitting_to_selection(
        self,
        *,
        extent: float = 1.0,
        subdiv: int = 3,
        hasuv: bool = False,
        orientation: Literal["quasi-Straight Fit", "Best Fit", "XZ Parallel", "YZ Parallel", "YX Parallel"] | int = "quasi-Straight Fit",
    ) -> None:
        """Fit a plane to selection

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_plane_fitting_to_selection
        """
    def generate_polyline_from_planar_section(
        self,
        *,
        planeaxis: Literal["X Axis", "Y Axis", "Z Axis", "Custom Axis"] | int = "X Axis",
        customaxis: ArrayLike = ...,
        planeoffset: float = 0.0,
        relativeto: Literal["Bounding box center", "Bounding box min", "Origin"] | int = "Origin",
        createsectionsurface: bool = False,
        splitsurfacewithsection: bool = False,
    ) -> None:
        """Compute Planar Section

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_polyline_from_planar_section
        """
    def generate_polyline_from_selected_edges(
        self,
    ) -> None:
        """Build a Polyline from Selected Edges

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_polyline_from_selected_edges
        """
    def generate_polyline_from_selection_perimeter(
        self,
    ) -> None:
        """Create Selection Perimeter Polyline

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_polyline_from_selection_perimeter
        """
    def generate_resampled_uniform_mesh(
        self,
        *,
        cellsize: PercentageValue | PureValue = ...,
        offset: PercentageValue | PureValue = ...,
        mergeclosevert: bool = False,
        discretize: bool = False,
        multisample: bool = False,
        absdist: bool = False,
    ) -> None:
        """Uniform Mesh Resampling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_resampled_uniform_mesh
        """
    def generate_sampling_clustered_vertex(
        self,
        *,
        threshold: PercentageValue | PureValue = ...,
        sampling: Literal["Average", "Closest to center"] | int = "Closest to center",
        selected: bool = False,
    ) -> None:
        """Clustered Vertex Sampling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_sampling_clustered_vertex
        """
    def generate_sampling_element(
        self,
        *,
        sampling: Literal["Vertex", "Edge", "Face"] | int = "Vertex",
        samplenum: int = ...,
    ) -> None:
        """Mesh Element Sampling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_sampling_element
        """
    def generate_sampling_montecarlo(
        self,
        *,
        samplenum: int = ...,
        weighted: bool = False,
        perfacenormal: bool = False,
        radiusvariance: float = 1.0,
        exactnum: bool = True,
        edgesampling: bool = False,
    ) -> None:
        """Montecarlo Sampling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_sampling_montecarlo
        """
    def generate_sampling_poisson_disk(
        self,
        *,
        samplenum: int = 1000,
        radius: PercentageValue | PureValue = ...,
        montecarlorate: int = 20,
        savemontecarlo: bool = False,
        approximategeodesicdistance: bool = False,
        subsample: bool = False,
        refineflag: bool = False,
        refinemesh: int = ...,
        bestsampleflag: bool = True,
        bestsamplepool: int = 10,
        exactnumflag: bool = False,
        exactnumtolerance: float = 0.005,
        radiusvariance: float = 1.0,
    ) -> None:
        """Poisson-disk Sampling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_sampling_poisson_disk
        """
    def generate_sampling_regular_recursive(
        self,
        *,
        cellsize: PercentageValue | PureValue = ...,
        offset: PercentageValue | PureValue = ...,
    ) -> None:
        """Regular Recursive Sampling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_sampling_regular_recursive
        """
    def generate_sampling_stratified_triangle(
        self,
        *,
        samplenum: int = 100000,
        sampling: Literal["Similar Triangle", "Dual Similar Triangle", "Long Edge Subdiv", "Sample Edges", "Sample NonFaux Edges"] | int = "Similar Triangle",
        random: bool = False,
    ) -> None:
        """Stratified Triangle Sampling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_sampling_stratified_triangle
        """
    def generate_sampling_texel(
        self,
        *,
        texturew: int = 512,
        textureh: int = 512,
        texturespace: bool = False,
        recovercolor: bool = False,
    ) -> None:
        """Texel Sampling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_sampling_texel
        """
    def generate_sampling_volumetric(
        self,
        *,
        samplesurfradius: PercentageValue | PureValue = ...,
        samplevolnum: int = 200000,
        poissonfiltering: bool = True,
        poissonradius: PercentageValue | PureValue = ...,
    ) -> None:
        """Volumetric Sampling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_sampling_volumetric
        """
    def generate_sampling_voronoi(
        self,
        *,
        iternum: int = 10,
        samplenum: int = 10,
        radiusvariance: float = 1.0,
        colorstrategy: Literal["None", "Seed Distance", "Border Distance", "Region Area"] | int = "Seed Distance",
        distancetype: Literal["Euclidean", "Quality Weighted", "Anisotropic"] | int = "Euclidean",
        preprocessflag: bool = False,
        refinefactor: int = 10,
        perturbprobability: float = 0.0,
        perturbamount: float = 0.001,
        randomseed: int = 0,
        relaxtype: Literal["Geodesic", "Squared Distance", "Restricted"] | int = "Squared Distance",
    ) -> None:
        """Voronoi Sampling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_sampling_voronoi
        """
    def generate_simplified_point_cloud(
        self,
        *,
        samplenum: int = 1000,
        radius: PercentageValue | PureValue = ...,
        bestsampleflag: bool = True,
        bestsamplepool: int = 10,
        exactnumflag: bool = False,
        exactnumtolerance: float = 0.005,
    ) -> None:
        """Point Cloud Simplification

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_simplified_point_cloud
        """
    def generate_solid_wireframe(
        self,
        *,
        edgecylflag: bool = True,
        edgecylradius: PercentageValue | PureValue = ...,
        vertcylflag: bool = False,
        vertcylradius: PercentageValue | PureValue = ...,
        vertsphflag: bool = True,
        vertsphradius: PercentageValue | PureValue = ...,
        faceextflag: bool = True,
        faceextheight: PercentageValue | PureValue = ...,
        faceextinset: PercentageValue | PureValue = ...,
        edgefauxflag: bool = True,
        cylindersidenum: int = 16,
    ) -> None:
        """Create Solid Wireframe

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_solid_wireframe
        """
    def generate_splitting_by_connected_components(
        self,
        *,
        delete_source_mesh: bool = False,
    ) -> None:
        """Split in Connected Components

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_splitting_by_connected_components
        """
    def generate_surface_reconstruction_ball_pivoting(
        self,
        *,
        ballradius: PercentageValue | PureValue = ...,
        clustering: float = 20.0,
        creasethr: float = 90.0,
        deletefaces: bool = False,
    ) -> None:
        """Surface Reconstruction: Ball Pivoting

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_surface_reconstruction_ball_pivoting
        """
    def generate_surface_reconstruction_screened_poisson(
        self,
        *,
        visiblelayer: bool = False,
        depth: int = 8,
        fulldepth: int = 5,
        cgdepth: int = 0,
        scale: float = 1.1,
        samplespernode: float = 1.5,
        pointweight: float = 4.0,
        iters: int = 8,
        confidence: bool = False,
        preclean: bool = False,
        threads: int = 2,
    ) -> None:
        """Surface Reconstruction: Screened Poisson

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_surface_reconstruction_screened_poisson
        """
    def generate_surface_reconstruction_vcg(
        self,
        *,
        voxsize: PercentageValue | PureValue = ...,
        subdiv: int = 1,
        geodesic: float = 2.0,
        openresult: bool = True,
        smoothnum: int = 1,
        widenum: int = 3,
        mergecolor: bool = False,
        simplification: bool = False,
        normalsmooth: int = 3,
    ) -> None:
        """Surface Reconstruction: VCG

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_surface_reconstruction_vcg
        """
    def generate_voronoi_atlas_parametrization(
        self,
        *,
        regionnum: int = 10,
        overlapflag: bool = False,
    ) -> None:
        """Parametrization: Voronoi Atlas

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_voronoi_atlas_parametrization
        """
    def generate_voronoi_filtering(
        self,
        *,
        threshold: float = 10.0,
    ) -> None:
        """Voronoi Filtering

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_voronoi_filtering
        """
    def generate_voronoi_scaffolding(
        self,
        *,
        samplesurfradius: PercentageValue | PureValue = ...,
        samplevolnum: int = 100000,
        voxelres: int = 50,
        isothr: float = 1.0,
        smoothstep: int = 3,
        relaxstep: int = 5,
        surfflag: bool = True,
        elemtype: Literal["Seed", "Edge", "Face"] | int = "Edge",
    ) -> dict[str, Any] | None:
        """Voronoi Scaffolding

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#generate_voronoi_scaffolding
        """
    def get_area_and_perimeter_of_selection(
        self,
    ) -> _GetAreaAndPerimeterOfSelection:
        """Compute Area/Perimeter of selection

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_area_and_perimeter_of_selection
        """
    def get_depth_complexity(
        self,
        *,
        onprimitive: Literal["On vertices", "On Faces"] | int = "On vertices",
        numberrays: int = 128,
        depthtexturesize: int = 512,
        peelingiteration: int = 10,
        peelingtolerance: float = 1e-07,
    ) -> dict[str, Any] | None:
        """Depth complexity

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_depth_complexity
        """
    def get_geometric_measures(
        self,
    ) -> _GetGeometricMeasures:
        """Compute Geometric Measures

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_geometric_measures
        """
    def get_hausdorff_distance(
        self,
        *,
        sampledmesh: int = ...,
        targetmesh: int = ...,
        savesample: bool = False,
        samplevert: bool = True,
        sampleedge: bool = False,
        samplefauxedge: bool = False,
        sampleface: bool = False,
        samplenum: int = ...,
        maxdist: PercentageValue | PureValue = ...,
    ) -> _GetHausdorffDistance:
        """Hausdorff Distance

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_hausdorff_distance
        """
    def get_overlapping_meshes_graph(
        self,
        *,
        ogsize: int = 50000,
    ) -> None:
        """Overlapping Meshes

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_overlapping_meshes_graph
        """
    def get_scalar_histogram_per_face(
        self,
        *,
        histmin: float = 0.0,
        histmax: float = ...,
        areaweighted: bool = False,
        binnum: int = 20,
    ) -> _GetScalarHistogramPerFace:
        """Per Face Quality Histogram

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_scalar_histogram_per_face
        """
    def get_scalar_histogram_per_vertex(
        self,
        *,
        histmin: float = ...,
        histmax: float = ...,
        areaweighted: bool = False,
        binnum: int = 20,
    ) -> _GetScalarHistogramPerVertex:
        """Per Vertex Quality Histogram

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_scalar_histogram_per_vertex
        """
    def get_scalar_statistics_per_face(
        self,
    ) -> _GetScalarStatisticsPerFace:
        """Per Face Quality Stat

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_scalar_statistics_per_face
        """
    def get_scalar_statistics_per_vertex(
        self,
    ) -> _GetScalarStatisticsPerVertex:
        """Per Vertex Quality Stat

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_scalar_statistics_per_vertex
        """
    def get_topological_measures(
        self,
    ) -> _GetTopologicalMeasures:
        """Compute Topological Measures

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_topological_measures
        """
    def get_topological_measures_from_quad_mesh(
        self,
    ) -> _GetTopologicalMeasuresFromQuadMesh:
        """Compute Topological Measures for Quad Meshes

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#get_topological_measures_from_quad_mesh
        """
    def get_willmore_measures(
        self,
    ) -> _GetWillmoreMeasures:
        """Compute area, Gaussian, mean and Willmore energy of the whole surface."""
    def load_active_raster_cameras(
        self,
        *,
        importfile: str,
    ) -> dict[str, Any] | None:
        """Import cameras for active rasters from file

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#load_active_raster_cameras
        """
    def meshing_close_holes(
        self,
        *,
        maxholesize: int = 30,
        selected: bool = ...,
        newfaceselected: bool = True,
        selfintersection: bool = True,
        refinehole: bool = False,
        refineholeedgelen: PercentageValue | PureValue = ...,
    ) -> _MeshingCloseHoles:
        """Close Holes

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_close_holes
        """
    def meshing_cut_along_crease_edges(
        self,
        *,
        angledeg: float = 90.0,
    ) -> None:
        """Cut mesh along crease edges

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_cut_along_crease_edges
        """
    def meshing_decimation_clustering(
        self,
        *,
        threshold: PercentageValue | PureValue = ...,
    ) -> None:
        """Simplification: Clustering Decimation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_decimation_clustering
        """
    def meshing_decimation_edge_collapse_for_marching_cube_meshes(
        self,
    ) -> None:
        """Simplification: Edge Collapse for Marching Cube meshes

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_decimation_edge_collapse_for_marching_cube_meshes
        """
    def meshing_decimation_quadric_edge_collapse(
        self,
        *,
        targetfacenum: int = ...,
        targetperc: float = 0.0,
        qualitythr: float = 0.3,
        preserveboundary: bool = False,
        boundaryweight: float = 1.0,
        preservenormal: bool = False,
        preservetopology: bool = False,
        optimalplacement: bool = True,
        planarquadric: bool = False,
        planarweight: float = 0.001,
        qualityweight: bool = False,
        autoclean: bool = True,
        selected: bool = ...,
    ) -> None:
        """Simplification: Quadric Edge Collapse Decimation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_decimation_quadric_edge_collapse
        """
    def meshing_decimation_quadric_edge_collapse_with_texture(
        self,
        *,
        targetfacenum: int = ...,
        targetperc: float = 0.0,
        qualitythr: float = 0.3,
        extratcoordw: float = 1.0,
        preserveboundary: bool = False,
        boundaryweight: float = 1.0,
        optimalplacement: bool = True,
        preservenormal: bool = False,
        planarquadric: bool = False,
        selected: bool = ...,
    ) -> None:
        """Simplification: Quadric Edge Collapse Decimation (with texture)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_decimation_quadric_edge_collapse_with_texture
        """
    def meshing_edge_flip_by_curvature_optimization(
        self,
        *,
        selection: bool = ...,
        pthreshold: float = 1.0,
        curvtype: Literal["mean", "norm squared", "absolute"] | int = "mean",
    ) -> None:
        """Curvature flipping optimization

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_edge_flip_by_curvature_optimization
        """
    def meshing_edge_flip_by_planar_optimization(
        self,
        *,
        selection: bool = ...,
        pthreshold: float = 1.0,
        planartype: Literal["area/max side", "inradius/circumradius", "mean ratio", "delaunay", "topology"] | int = "area/max side",
        iterations: int = 1,
    ) -> None:
        """Planar flipping optimization

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_edge_flip_by_planar_optimization
        """
    def meshing_edge_flip_by_willmore_optimization(
        self,
        *,
        preset: Literal["paper", "faithful", "smooth", "shape"] | int = "paper",
        selection: bool = ...,
        energy: Literal["virtual willmore", "willmore", "uniform virtual willmore", "area", "mean curvature", "gaussian curvature", "delaunay"] | int = "virtual willmore",
        search: Literal["parallel greedy", "greedy", "variable depth", "annealing", "thorough"] | int = "parallel greedy",
        depth: int = 5,
        breadth: int = 3,
        sweeps: int = 200,
        seed: int = 0,
        virtualpoint: Literal["midpoint", "closest"] | float = "midpoint",
        monotone: bool = True,
        foldangle: float = 90.0,
        minshape: float = 0.05,
        maxdeviation: PercentageValue | PureValue = ...,
        checkintersections: bool = False,
        featuredeg: float = 180.0,
        maxflips: int = -1,
        allowloss: bool = False,
    ) -> _MeshingEdgeFlipByWillmoreOptimization:
        """Mesh optimization by edge flipping, to make the surface locally as near to a sphere as its vertices allow."""
    def meshing_invert_face_orientation(
        self,
        *,
        forceflip: bool = True,
        onlyselected: bool = False,
    ) -> None:
        """Invert Faces Orientation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_invert_face_orientation
        """
    def meshing_isotropic_explicit_remeshing(
        self,
        *,
        iterations: int = 10,
        adaptive: bool = False,
        selectedonly: bool = False,
        targetlen: PercentageValue | PureValue = ...,
        featuredeg: float = 30.0,
        checksurfdist: bool = True,
        maxsurfdist: PercentageValue | PureValue = ...,
        splitflag: bool = True,
        collapseflag: bool = True,
        swapflag: bool = True,
        smoothflag: bool = True,
        reprojectflag: bool = True,
    ) -> None:
        """Remeshing: Isotropic Explicit Remeshing

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_isotropic_explicit_remeshing
        """
    def meshing_merge_close_vertices(
        self,
        *,
        threshold: PercentageValue | PureValue = ...,
    ) -> None:
        """Merge Close Vertices

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_merge_close_vertices
        """
    def meshing_poly_to_tri(
        self,
    ) -> None:
        """Turn into a Pure-Triangular mesh

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_poly_to_tri
        """
    def meshing_re_orient_faces_by_geometry(
        self,
        *,
        rays: int = 64,
        parity_sampling: bool = False,
    ) -> None:
        """Reorient face normals by geometry

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_re_orient_faces_by_geometry
        """
    def meshing_re_orient_faces_coherently(
        self,
    ) -> None:
        """Re-Orient all faces coherently

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_re_orient_faces_coherently
        """
    def meshing_refine_by_function(
        self,
        *,
        condselect: str = "(q0 >= 0 && q1 >= 0)",
        x: str = "(x0+x1)/2",
        y: str = "(y0+y1)/2",
        z: str = "(z0+z1)/2",
    ) -> None:
        """Refine User-Defined

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_refine_by_function
        """
    def meshing_remove_all_faces(
        self,
        *,
        alllayers: bool = False,
    ) -> None:
        """Delete ALL Faces

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_all_faces
        """
    def meshing_remove_connected_component_by_diameter(
        self,
        *,
        mincomponentdiag: PercentageValue | PureValue = ...,
        removeunref: bool = True,
    ) -> None:
        """Remove Isolated pieces (wrt Diameter)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_connected_component_by_diameter
        """
    def meshing_remove_connected_component_by_face_number(
        self,
        *,
        mincomponentsize: int = 25,
        removeunref: bool = True,
    ) -> None:
        """Remove Isolated pieces (wrt Face Num.)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_connected_component_by_face_number
        """
    def meshing_remove_duplicate_faces(
        self,
    ) -> None:
        """Remove Duplicate Faces

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_duplicate_faces
        """
    def meshing_remove_duplicate_vertices(
        self,
    ) -> None:
        """Remove Duplicate Vertices

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_duplicate_vertices
        """
    def meshing_remove_folded_faces(
        self,
    ) -> None:
        """Remove Isolated Folded Faces by Edge Flip

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_folded_faces
        """
    def meshing_remove_null_faces(
        self,
    ) -> None:
        """Remove Zero Area Faces

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_null_faces
        """
    def meshing_remove_selected_faces(
        self,
    ) -> None:
        """Delete Selected Faces

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_selected_faces
        """
    def meshing_remove_selected_vertices(
        self,
    ) -> None:
        """Delete Selected Vertices

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_selected_vertices
        """
    def meshing_remove_selected_vertices_and_faces(
        self,
    ) -> None:
        """Delete Selected Faces and Vertices

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_selected_vertices_and_faces
        """
    def meshing_remove_t_vertices(
        self,
        *,
        method: Literal["Edge Collapse", "Edge Flip"] | int = "Edge Collapse",
        threshold: float = 40.0,
        repeat: bool = True,
    ) -> None:
        """Remove T-Vertices

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_t_vertices
        """
    def meshing_remove_unreferenced_vertices(
        self,
    ) -> None:
        """Remove Unreferenced Vertices

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_unreferenced_vertices
        """
    def meshing_remove_vertices_by_scalar(
        self,
        *,
        maxqualitythr: PercentageValue | PureValue = ...,
    ) -> None:
        """Remove Vertices wrt Quality

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_remove_vertices_by_scalar
        """
    def meshing_repair_non_manifold_edges(
        self,
        *,
        method: Literal["Remove Faces", "Split Vertices"] | int = "Remove Faces",
    ) -> None:
        """Repair non Manifold Edges

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_repair_non_manifold_edges
        """
    def meshing_repair_non_manifold_vertices(
        self,
        *,
        vertdispratio: float = 0.0,
    ) -> None:
        """Repair non Manifold Vertices by splitting

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_repair_non_manifold_vertices
        """
    def meshing_snap_mismatched_borders(
        self,
        *,
        edgedistratio: float = 0.01,
        unifyvertices: bool = True,
    ) -> None:
        """Snap Mismatched Borders

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_snap_mismatched_borders
        """
    def meshing_surface_subdivision_butterfly(
        self,
        *,
        iterations: int = 3,
        threshold: PercentageValue | PureValue = ...,
        selected: bool = ...,
    ) -> None:
        """Subdivision Surfaces: Butterfly Subdivision

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_surface_subdivision_butterfly
        """
    def meshing_surface_subdivision_catmull_clark(
        self,
        *,
        iterations: int = 2,
    ) -> None:
        """Subdivision Surfaces: Catmull-Clark

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_surface_subdivision_catmull_clark
        """
    def meshing_surface_subdivision_doo_sabin(
        self,
        *,
        iterations: int = 2,
    ) -> None:
        """Subdivision Surfaces: Doo Sabin

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_surface_subdivision_doo_sabin
        """
    def meshing_surface_subdivision_loop(
        self,
        *,
        loopweight: Literal["Loop", "Enhance regularity", "Enhance continuity"] | int = "Loop",
        iterations: int = 3,
        threshold: PercentageValue | PureValue = ...,
        selected: bool = ...,
    ) -> None:
        """Subdivision Surfaces: Loop

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_surface_subdivision_loop
        """
    def meshing_surface_subdivision_ls3_loop(
        self,
        *,
        loopweight: Literal["Loop", "Enhance regularity", "Enhance continuity"] | int = "Loop",
        iterations: int = 3,
        threshold: PercentageValue | PureValue = ...,
        selected: bool = ...,
    ) -> None:
        """Subdivision Surfaces: LS3 Loop

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_surface_subdivision_ls3_loop
        """
    def meshing_surface_subdivision_midpoint(
        self,
        *,
        iterations: int = 3,
        threshold: PercentageValue | PureValue = ...,
        selected: bool = ...,
    ) -> None:
        """Subdivision Surfaces: Midpoint

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_surface_subdivision_midpoint
        """
    def meshing_tri_to_quad_by_4_8_subdivision(
        self,
    ) -> None:
        """Tri to Quad by 4-8 Subdivision

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_tri_to_quad_by_4_8_subdivision
        """
    def meshing_tri_to_quad_by_smart_triangle_pairing(
        self,
    ) -> None:
        """Tri to Quad by smart triangle pairing

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_tri_to_quad_by_smart_triangle_pairing
        """
    def meshing_tri_to_quad_dominant(
        self,
        *,
        level: Literal["Fewest triangles", "(in between)", "Better quad shape"] | int = "Fewest triangles",
    ) -> None:
        """Turn into Quad-Dominant mesh

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_tri_to_quad_dominant
        """
    def meshing_vertex_attribute_seam(
        self,
        *,
        normalmode: Literal["None", "Vertex", "Wedge", "Face"] | int = "None",
        colormode: Literal["None", "Vertex", "Wedge", "Face"] | int = "None",
        texcoordmode: Literal["None", "Vertex", "Wedge"] | int = "None",
    ) -> None:
        """Vertex Attribute Seam

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#meshing_vertex_attribute_seam
        """
    def nxs_build(
        self,
        *,
        input_file: str,
        output_file: str,
        node_faces: int = 32768,
        top_node_faces: int = 4096,
        tex_quality: int = 95,
        ram: int = 2000,
        skiplevels: int = 0,
        origin: ArrayLike = ...,
        center: bool = False,
        pow_2_textures: bool = False,
        deepzoom: bool = False,
        adaptive: float = 0.333,
    ) -> dict[str, Any] | None:
        """NXS Build

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#nxs_build
        """
    def nxs_compress(
        self,
        *,
        input_file: str,
        output_file: str,
        nxz_vertex_quantization: float = 0.0,
        vertex_bits: int = 0,
        quantization_factor: float = 0.1,
        luma_bits: int = 6,
        chroma_bits: int = 6,
        alpha_bits: int = 5,
        normal_bits: int = 10,
        textures_precision: float = 0.25,
    ) -> dict[str, Any] | None:
        """NXS Compress

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#nxs_compress
        """
    def raster_alignment_mutual_information(
        self,
        *,
        rendering_mode: Literal["Combined", "Normal map", "Color per vertex", "Specular", "Silhouette", "Specular combined"] | int = "Combined",
        estimate_focal: bool = False,
        fine: bool = True,
        numofiterations: int = 100,
        tolerance: float = 0.1,
        expectedvariance: float = 2.0,
        backgroundweight: int = 2,
    ) -> dict[str, Any] | None:
        """Image alignment: Mutual Information

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#raster_alignment_mutual_information
        """
    def raster_global_refinement_mutual_information(
        self,
        *,
        renderingmode: Literal["Combined", "Normal map", "Color per vertex", "Specular", "Silhouette", "Specular combined"] | int = "Combined",
        max_number_of_refinement_steps: int = 5,
        threshold_for_refinement_convergence: float = 1.2,
        pre_alignment: bool = False,
        estimate_focal: bool = True,
        fine: bool = True,
    ) -> dict[str, Any] | None:
        """Image Registration: Global refinement using Mutual Information

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#raster_global_refinement_mutual_information
        """
    def save_active_raster_cameras(
        self,
        *,
        exportfile: Literal["Bundler .out", "Agisoft xml"] | int = "Bundler .out",
        newname: str = "cameras",
    ) -> None:
        """Export active rasters cameras to file

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#save_active_raster_cameras
        """
    def save_snapshot(
        self,
        *,
        imagebackgroundcolor: Color = ...,
        imagewidth: int = 512,
        imageheight: int = 512,
        imagefilename: str = ...,
    ) -> dict[str, Any] | None:
        """GPU Filter Example

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#save_snapshot
        """
    def set_camera_per_mesh(
        self,
    ) -> None:
        """Set Mesh Camera

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#set_camera_per_mesh
        """
    def set_camera_per_raster(
        self,
    ) -> None:
        """Set Raster Camera

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#set_camera_per_raster
        """
    def set_color_per_vertex(
        self,
        *,
        color1: Color = ...,
        onselected: bool = False,
    ) -> None:
        """Vertex Color Filling

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#set_color_per_vertex
        """
    def set_matrix(
        self,
        *,
        transformmatrix: ArrayLike = ...,
        compose: bool = False,
        freeze: bool = True,
        alllayers: bool = False,
    ) -> None:
        """Matrix: Set/Copy Transformation

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#set_matrix
        """
    def set_matrix_identity(
        self,
        *,
        alllayers: bool = False,
    ) -> None:
        """Matrix: Reset Current Matrix

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#set_matrix_identity
        """
    def set_mesh_name(
        self,
        *,
        newname: str = ...,
    ) -> None:
        """Rename Current Mesh

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#set_mesh_name
        """
    def set_raster_name(
        self,
        *,
        newname: str = "",
    ) -> None:
        """Rename Current Raster

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#set_raster_name
        """
    def set_selection_all(
        self,
        *,
        allfaces: bool = True,
        allverts: bool = True,
    ) -> None:
        """Select All

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#set_selection_all
        """
    def set_selection_none(
        self,
        *,
        allfaces: bool = True,
        allverts: bool = True,
    ) -> None:
        """Select None

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#set_selection_none
        """
    def set_texture_per_mesh(
        self,
        *,
        textname: str = ...,
        use_dummy_texture: bool = False,
        dummy_img_size: int = 512,
        dummy_check_size: int = 8,
        dummy_type: Literal["Checkboard", "Grid"] | int = "Checkboard",
    ) -> None:
        """Set Texture

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#set_texture_per_mesh
        """
    def transfer_attributes_per_vertex(
        self,
        *,
        sourcemesh: int = ...,
        targetmesh: int = ...,
        vertexsampling: bool = False,
        geomtransfer: bool = False,
        normaltransfer: bool = False,
        colortransfer: bool = True,
        qualitytransfer: bool = False,
        selectiontransfer: bool = False,
        qualitydistance: bool = False,
        savebarycentric: bool = False,
        upperbound: PercentageValue | PureValue = ...,
        onselected: bool = False,
    ) -> None:
        """Vertex Attribute Transfer

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#transfer_attributes_per_vertex
        """
    def transfer_attributes_to_texture_per_vertex(
        self,
        *,
        sourcemesh: int = ...,
        targetmesh: int = ...,
        attributeenum: Literal["Vertex Color", "Vertex Normal", "Vertex Quality", "Texture Color"] | int = "Vertex Color",
        upperbound: PercentageValue | PureValue = ...,
        textname: str = "texture.png",
        textw: int = 1024,
        texth: int = 1024,
        overwrite: bool = False,
        pullpush: bool = True,
    ) -> None:
        """Transfer: Vertex Attributes to Texture (1 or 2 meshes)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#transfer_attributes_to_texture_per_vertex
        """
    def transfer_iso_parametrization_between_meshes(
        self,
        *,
        sourcemesh: int = ...,
        targetmesh: int = ...,
    ) -> dict[str, Any] | None:
        """Iso Parametrization transfer between meshes

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#transfer_iso_parametrization_between_meshes
        """
    def transfer_texture_to_color_per_vertex(
        self,
        *,
        sourcemesh: int = ...,
        targetmesh: int = ...,
        upperbound: PercentageValue | PureValue = ...,
    ) -> None:
        """Transfer: Texture to Vertex Color (1 or 2 meshes)

        https://pymeshlab.readthedocs.io/en/2025.7.post1/filter_list.html#transfer_texture_to_color_per_vertex
        """

def filter_list() -> list[str]:
    """Returns a list of all the (python names of the) filters that have been loaded in the current session of PyMeshLab."""
def load_default_plugins() -> None:
    """Loads the set of default plugins that are shipped with pymeshlab."""
def load_plugin(arg0: str, /) -> None:
    """Allows to load an extra plugin into PyMeshLab, given the file name of the MeshLab plugin."""
def number_plugins() -> int:
    """Returns the number of plugins loaded in the current session of PyMeshLab."""
def plugin_number() -> int:
    """Returns the number of plugins loaded in the current session of PyMeshLab."""
def print_filter_list() -> None:
    """Prints the list of all the filters have been loaded in the current session of PyMeshLab."""
def print_filter_parameter_list(arg0: str, /) -> None:
    """Prints the list of the parameters of the given filter, with their default values."""
def print_plugin_filter_list(arg0: str, /) -> None:
    """Prints the list of filters contained in the given plugin name."""
def print_plugin_list() -> None:
    """Prints all the meshlab plugins loaded in the current session of PyMeshLab."""
def print_pymeshlab_version() -> None:
    """Prints the PyMeshLab version that is currently running."""
def search(arg0: str, /) -> None:
    """Performs a search between the filters of pymeshlab with the given a keyword."""
