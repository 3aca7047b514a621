"""Water forces on bodies of pieces at the waterline: the compiled kernel over the table of the pieces."""
