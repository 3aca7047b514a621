"""How fast is each gait, and what does speed cost?"""
