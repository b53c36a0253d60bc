"""The paper's figures computed anew: one file for each kind of figure, each function gives a PaperFigure."""
