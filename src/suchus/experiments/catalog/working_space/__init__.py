"""How much room does the snout reach, on four feet and on hind feet and tail?"""
