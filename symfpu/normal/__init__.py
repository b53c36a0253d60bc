"""Normal frequencies of tori: the linearised flow reduced to constant coefficients."""
