"""How fast and how well does it swim at other frequencies, amplitudes and wavelengths?"""
