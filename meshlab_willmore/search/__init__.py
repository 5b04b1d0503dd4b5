"""How an energy is minimised: the greedy search, its queue and its memory."""
