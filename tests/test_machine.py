"""A fault of the machine is found among the causes of an error."""

from meshlab_willmore.machine import MachineError, SettingError, fault_of


def test_the_machines_fault_is_found_behind_others():
    fault = SettingError("why")
    error = ValueError("a.ply: it failed")
    error.__cause__ = RuntimeError("it failed")
    assert fault_of(error) is None
    error.__cause__.__cause__ = fault
    assert fault_of(error) is fault
    assert fault_of(None) is None
    assert isinstance(fault, MachineError)
