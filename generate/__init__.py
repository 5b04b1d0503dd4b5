"""Commands that write files of the package from what PyMeshLab is and says.

A user never runs them, so they are not in the package. They answer no question, so they are no
studies. Tests run them and compare what they write with the files in the repository.
"""
