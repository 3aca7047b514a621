"""What the article is."""

TITLE = "Structure design and coordinated motion analysis of bionic crocodile robot"
AUTHORS = ("Jun Wang", "Jingya Zheng", "Yuhang Zhao", "Kai Yang")
