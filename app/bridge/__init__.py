"""All that leans on the insides of viser; the rest of the program uses its public interface."""
