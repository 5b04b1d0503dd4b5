"""A fault of the machine is found among the causes of an error."""

from meshlab_willmore.machine import MachineError, SettingError, fault_of


def test_a_fault_of_the_machine_is_found_among_causes():
    fault = SettingError("why")
    error = ValueError("a.ply: it failed")
    error.__cause__ = RuntimeError("it failed")
    assert fault_of(error) is None
    error.__cause__.__cause__ = fault
    assert fault_of(error) is fault
    assert fault_of(None) is None
    assert isinstance(fault, MachineError)
